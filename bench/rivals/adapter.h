// One rival: the same mesh and, where it takes one, the same number of regions in; a label a face out.
#pragma once

#include <quadseg/mesh.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace quadseg::bench {

struct Traits {
    bool takes_regions = false;     ///< the number of regions can be asked for
    bool labels_everything = true;  ///< leaves no face without a label
    bool long_running = false;      ///< minutes on 100K faces: only with --all
};

class Adapter {
  public:
    virtual ~Adapter() = default;
    /// Brings the mesh into the rival's own form; not timed as its work.
    virtual void prepare(const Mesh& mesh, std::size_t regions) = 0;
    /// What is timed.
    virtual void segment() = 0;
    /// One a face in the mesh's order, −1: unlabelled.
    virtual std::vector<std::int32_t> labels() const = 0;
};

struct Rival {
    std::string name;
    Traits traits;
    std::unique_ptr<Adapter> (*make)();
};

/// Ours first: what the others are compared with.
std::vector<Rival> rivals();

std::unique_ptr<Adapter> make_ours();
std::unique_ptr<Adapter> make_ours_automatic();
std::unique_ptr<Adapter> make_ours_paper();
std::unique_ptr<Adapter> make_vsa_l21();
std::unique_ptr<Adapter> make_vsa_l21_as_documented();
std::unique_ptr<Adapter> make_vsa_l2();
std::unique_ptr<Adapter> make_vsa_quadric();
std::unique_ptr<Adapter> make_vsa_quadric_incremental();
std::unique_ptr<Adapter> make_ransac();
std::unique_ptr<Adapter> make_ransac_tight();
std::unique_ptr<Adapter> make_region_growing();

}  // namespace quadseg::bench
