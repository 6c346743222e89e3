// What the program's exit status says. Part of the program's contract.
#pragma once

namespace quadseg::cli {

enum ExitCode {
    exit_done = 0,
    exit_defect = 1,   ///< a defect of ours, or the result could not be written
    exit_usage = 2,    ///< the command line makes no sense
    exit_input = 3,    ///< the input can't be read or used
    exit_stopped = 4,  ///< stopped by time-out or signal; a partial result, if there is one, is written and marked
};

/// Runs the program: parses, dispatches, maps every error to a message on stderr and an exit code.
int run(int argc, const char* const* argv);

}  // namespace quadseg::cli
