#include "tools/python/native/job.h"

#include <chrono>
#include <thread>
#include <utility>

namespace quadseg::python {

namespace py = pybind11;
using namespace std::chrono_literals;

namespace {

/// Only there do signals reach Python.
bool in_main_thread() {
    const py::module_ threading = py::module_::import("threading");
    return threading.attr("get_ident")().equal(threading.attr("main_thread")().attr("ident"));
}

}  // namespace

Job::Job(const Limits& limits) : progress_(limits.progress) {
    context_.set_threads(limits.threads);
    context_.set_memory_limit(limits.memory_limit);
    if (limits.timeout) context_.set_time_limit(*limits.timeout);
    if (progress_.is_none()) return;
    context_.on_progress([this](const Progress& progress) {
        {
            const std::lock_guard lock(mutex_);
            latest_ = progress;
        }
        changed_.notify_one();
        return true;
    });
}

void Job::run(const std::function<void(Context&)>& work) {
    if (progress_.is_none() && !in_main_thread()) {  // nothing to do meanwhile: no second thread
        const py::gil_scoped_release free;
        work(context_);
        return;
    }
    std::thread worker([&] {
        try {
            work(context_);
        } catch (...) {
            failure_ = std::current_exception();
        }
        {
            const std::lock_guard lock(mutex_);
            done_ = true;
        }
        changed_.notify_one();
    });
    const auto finished = [&] {
        const std::lock_guard lock(mutex_);
        return done_;
    };
    while (!finished()) {
        wait(!python_raised_);
        if (python_raised_) continue;
        deliver_progress();
        call_python([] {
            if (PyErr_CheckSignals() != 0) throw py::error_already_set();
        });
    }
    {
        const py::gil_scoped_release free;
        worker.join();
    }
    if (!python_raised_ && !failure_) deliver_progress();
    if (python_raised_) std::rethrow_exception(python_raised_);
    if (failure_) std::rethrow_exception(failure_);
}

/// Until something changes; with `poll` not longer than a human notices.
void Job::wait(bool poll) {
    const py::gil_scoped_release free;
    std::unique_lock lock(mutex_);
    const auto ready = [&] { return done_ || (poll && latest_); };
    if (poll) {
        changed_.wait_for(lock, 20ms, ready);
    } else {
        changed_.wait(lock, ready);
    }
}

void Job::deliver_progress() {
    std::optional<Progress> progress;
    {
        const std::lock_guard lock(mutex_);
        progress = std::exchange(latest_, std::nullopt);
    }
    if (!progress) return;
    call_python([&] {
        const py::object event =
            py::module_::import("quadseg._types")
                .attr("Progress")(to_string(progress->phase), progress->fraction, progress->regions, progress->energy);
        // None goes on, so that print and bars can be used as they are.
        if (progress_(event).is(py::bool_(false))) context_.cancel();
    });
}

void Job::call_python(const std::function<void()>& call) {
    try {
        call();
    } catch (py::error_already_set&) {
        python_raised_ = std::current_exception();
        context_.cancel();
    }
}

}  // namespace quadseg::python
