#include "read_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    for (const char* name : {"fuzz", "fuzz.off", "fuzz.obj", "fuzz.stl"}) {
        quadseg::fuzz::run(data, size, name, quadseg::io::read_contents);
    }
    return 0;
}
