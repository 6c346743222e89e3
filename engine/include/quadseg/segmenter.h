// The operations of a segmentation one by one, as the paper offers them to its user (section 4.3.3).
#pragma once

#include <quadseg/export.h>
#include <quadseg/segmentation.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace quadseg {

/// Holds a checked mesh and its current partition. Faces are named by input index, regions by their current label;
/// after any operation labels are 0 … regions−1. Not thread-safe; different objects are independent. Throws Error.
class QUADSEG_API Segmenter {
  public:
    /// Checks the mesh (as segment()); the arrays may go afterwards. The partition is one region a connected component.
    explicit Segmenter(const MeshView& mesh, const Options& options = {}, Context* context = nullptr);
    ~Segmenter();
    Segmenter(Segmenter&&) noexcept;
    Segmenter& operator=(Segmenter&&) noexcept;

    std::size_t region_count() const noexcept;
    std::span<const std::int32_t> labels() const;  ///< input face order; valid until the next operation
    Energy energy() const;
    const MeshReport& input() const noexcept;

    /// Watches, bounds and stops what follows; null: nothing does. A cancelled context stays cancelled, a segmenter
    /// goes on with another one.
    void set_context(Context* context);
    /// Other options for what follows. The partition stays, is split where new feature edges cut it, and fitted anew;
    /// the mesh is not prepared again. Forgets what could be undone.
    void set_options(const Options& options);
    /// Replaces the partition by the caller's: one label a face, any integers; disconnected regions are split.
    /// Undoable.
    void set_labels(std::span<const std::int32_t> labels);
    /// Replaces the partition by the whole automatic segmentation under the options. Undoable.
    StopReason run();
    /// New region whose seed is `face`, its proxy the plane of that face; one flood. Returns the new label. Undoable.
    std::int32_t insert(std::size_t face);
    /// Insertion by the paper's rule: in an invalid region first, else at the worst face of the worst region. Undoable.
    std::int32_t insert();
    /// Merges two adjacent regions and refits. Undoable. Throws invalid_argument when they do not touch.
    void merge(std::int32_t a, std::int32_t b);
    /// The energy that the merge of two adjacent regions would add, and whether the common fit is valid. Changes
    /// nothing.
    struct MergeCandidate {
        double increase;
        bool valid;
    };
    MergeCandidate merge_candidate(std::int32_t a, std::int32_t b) const;
    /// One Lloyd iteration (flood, fit, reseed) or up to `iterations`; returns the energy. Undoable.
    double relax(int iterations = 1);
    /// Post-processing of sections 4.4.1 to 4.4.3. smooth() is undoable; classify() and project() change no label.
    void smooth();
    void classify();
    /// 3V projected positions, input vertex order.
    std::vector<double> project() const;
    /// Takes the last undoable operation back; false when there is none.
    bool undo();
    /// The result as segment() returns it, of the current partition.
    Segmentation result() const;

  private:
    struct QUADSEG_LOCAL Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace quadseg
