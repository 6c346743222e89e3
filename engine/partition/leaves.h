// Leaves: the over-segmentation into small connected groups of faces that merging starts from.
#pragma once

#include "mesh/features.h"
#include "mesh/work_mesh.h"
#include "partition/regions.h"
#include "runtime/run_control.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace quadseg::partition {

/// Which edges a region may grow across: no borders, no barriers, no inactive faces.
struct Passage {
    const mesh::WorkMesh* mesh = nullptr;
    const mesh::FeatureEdges* barriers = nullptr;  ///< null: none
    std::span<const std::uint8_t> active = {};     ///< F' flags; empty: all

    bool is_active(std::size_t f) const noexcept { return active.empty() || active[f] != 0; }
    /// Face on the other side of edge k of the active face f; no_face where nothing may pass.
    std::int32_t across(std::size_t f, std::size_t k) const noexcept {
        const std::int32_t g = mesh->neighbors[f][k];
        if (g < 0 || (barriers != nullptr && ((*barriers)[f] >> k & 1U) != 0)) return mesh::no_face;
        return is_active(static_cast<std::size_t>(g)) ? g : mesh::no_face;
    }
};

struct LeafOptions {
    double angle = 8;           ///< degrees between a face and its leaf's running mean normal; twice it: its seed
    std::size_t largest = 128;  ///< faces of a leaf that is not exactly plane
    std::size_t smallest_coplanar = 9;  ///< exactly coplanar groups of at least so many faces are one leaf; 0: none
    /// F' numbers: faces grow leaves, and join them, in ascending order of these, and leaves are numbered in the order
    /// in which they grow. The same leaves however the mesh lies and is numbered, as long as it is one block. Empty: in
    /// the order of the faces and of their edges.
    std::span<const double> order = {};
    std::span<const Vec3> normals = {};  ///< to grow by instead of the mesh's (filtered ones on scans); empty: those
};

/// Every active face in an edge-connected leaf 0 … count−1 (numbered along the faces); inactive faces −1. Grown in
/// blocks of 16384, with an order of 65536 consecutive (Morton-ordered) faces, so that blocks are independent tasks.
struct Leaves {
    Labels labels;
    std::size_t count = 0;
};
Leaves grow_leaves(const Passage& passage, const LeafOptions& options, const runtime::RunControl& control);

/// Splits every label ≥ 0 into its edge-connected parts across the passage; renumbers by first face; returns the count.
std::size_t connected_parts(const Passage& passage, Labels& labels);

}  // namespace quadseg::partition
