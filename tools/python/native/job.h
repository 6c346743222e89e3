// Runs a call of the library on a thread of its own, while the Python thread that asked for it, without the GIL, waits,
// hands progress on and looks for signals. So callbacks always come in the caller's thread, and Ctrl-C works. Where
// there is neither a callback nor signals, the caller's thread does the work itself.
#pragma once

#include <quadseg/context.h>

#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <pybind11/pybind11.h>

namespace quadseg::python {

/// What every call takes beside its data.
struct Limits {
    pybind11::object progress;      ///< callable or None
    std::optional<double> timeout;  ///< seconds
    int threads = 0;
    std::size_t memory_limit = 0;  ///< bytes
};

class Job {
  public:
    explicit Job(const Limits& limits);

    /// Runs `work` to its end; the GIL is held on entry and exit, not in between. Throws what `work` threw, or what the
    /// progress callback or a signal handler raised; then the work has been cancelled and has ended.
    void run(const std::function<void(Context&)>& work);

  private:
    void wait(bool poll);
    void deliver_progress();
    void call_python(const std::function<void()>& call);

    Context context_;
    pybind11::object progress_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::optional<Progress> latest_;    // guarded by mutex_
    bool done_ = false;                 // guarded by mutex_
    std::exception_ptr failure_;        // of the work; written before done_
    std::exception_ptr python_raised_;  // of a callback or signal handler
};

}  // namespace quadseg::python
