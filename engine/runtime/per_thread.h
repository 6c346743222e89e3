// Scratch memory that every thread of a parallel loop has for itself. Never for results: which thread does what is
// chance.
#pragma once

#include <tbb/enumerable_thread_specific.h>

namespace quadseg::runtime {

template <class T>
class PerThread {
  public:
    T& local() { return values_.local(); }

  private:
    tbb::enumerable_thread_specific<T> values_;
};

}  // namespace quadseg::runtime
