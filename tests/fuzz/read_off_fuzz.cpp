#include "read_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return quadseg::fuzz::run(data, size, "fuzz.off", [](quadseg::io::FileContents& file, const auto& control) {
        return quadseg::io::read_off(file, control);
    });
}
