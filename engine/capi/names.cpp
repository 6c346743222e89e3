#include <quadseg/error.h>
#include <quadseg/quadseg.h>
#include <quadseg/segmentation.h>

#include <cstdint>

using namespace quadseg;

namespace {

/// The name of a number that comes from outside.
template <class Enum>
const char* name_of(std::int32_t number, Enum last) {
    return number >= 0 && number <= static_cast<std::int32_t>(last) ? to_string(static_cast<Enum>(number)) : "unknown";
}

// The numbers of the C interface are those of C++; a new one there must get its constant here.
static_assert(static_cast<int>(Phase::write) == QUADSEG_PHASE_WRITE);
static_assert(static_cast<int>(Preset::paper) == QUADSEG_PRESET_PAPER);
static_assert(static_cast<int>(Method::hierarchical) == QUADSEG_METHOD_HIERARCHICAL);
static_assert(surface_type_count == QUADSEG_FREEFORM + 1 && static_cast<int>(SurfaceType::blend) == QUADSEG_BLEND &&
              static_cast<int>(SurfaceType::hyperboloid_two_sheets) == QUADSEG_HYPERBOLOID_TWO_SHEETS);
static_assert(static_cast<int>(StopReason::cancelled) == QUADSEG_STOP_CANCELLED);
static_assert(static_cast<int>(Regularity::Kind::equal_radius) == QUADSEG_EQUAL_RADIUS);

}  // namespace

extern "C" {

const char* quadseg_status_name(quadseg_status status) {
    switch (status) {
        case QUADSEG_OK:
            return "ok";
        case QUADSEG_OUT_OF_MEMORY:
            return "out_of_memory";
        case QUADSEG_BUFFER_TOO_SMALL:
            return "buffer_too_small";
        default:
            return status > 0 ? name_of(status - 1, ErrorCode::internal) : "unknown";
    }
}

const char* quadseg_version() {
    return QUADSEG_VERSION;
}

const char* quadseg_phase_name(int32_t phase) {
    return name_of(phase, Phase::write);
}

const char* quadseg_surface_type_name(int32_t type) {
    return name_of(type, SurfaceType::freeform);
}

const char* quadseg_stop_name(int32_t stop) {
    return name_of(stop, StopReason::cancelled);
}

const char* quadseg_regularity_name(int32_t kind) {
    return name_of(kind, Regularity::Kind::equal_radius);
}

}  // extern "C"
