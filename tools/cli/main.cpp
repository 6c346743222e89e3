#include "tools/cli/exit_code.h"

int main(int argc, char** argv) {
    return quadseg::cli::run(argc, argv);
}
