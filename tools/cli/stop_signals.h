// Ctrl-C and SIGTERM cancel a Context, so that the best partial result is still written.
#pragma once

#include <quadseg/context.h>

namespace quadseg::cli {

/// While it lives, the first SIGINT or SIGTERM cancels the context; one more than .2 s later ends the program at once.
class StopSignals {
  public:
    explicit StopSignals(Context& context);
    ~StopSignals();
    StopSignals(const StopSignals&) = delete;
    StopSignals& operator=(const StopSignals&) = delete;
};

}  // namespace quadseg::cli
