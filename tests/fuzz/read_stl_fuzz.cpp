#include "read_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    for (const auto read : {quadseg::io::read_stl_ascii, quadseg::io::read_stl_binary}) {
        quadseg::fuzz::run(data, size, "fuzz.stl", read);
    }
    return 0;
}
