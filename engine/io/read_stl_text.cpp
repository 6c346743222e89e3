// STL as text: any number of solids, each a list of facets of three vertices. Words may be of either case.
#include "io/formats.h"
#include "io/mesh_faults.h"
#include "io/polled_resize.h"
#include "io/text_blocks.h"
#include "io/weld.h"
#include "runtime/parallel.h"

#include <algorithm>
#include <cmath>

namespace quadseg::io {
namespace {

struct Block {
    std::vector<double> corners;  ///< nine numbers a facet
    bool ends_in_solid = false;
    std::optional<Fault> fault;
};

/// `word` must be of lower case.
bool is_word(const char* p, std::string_view word) noexcept {
    for (const char c : word) {
        if ((*p >= 'A' && *p <= 'Z' ? *p - 'A' + 'a' : *p) != c) return false;
        ++p;
    }
    return is_blank(*p) || *p == '\n';
}

class FacetReader {
  public:
    FacetReader(const TextBlock& text, const char* end, Block& block)
        : p_(text.begin), limit_(text.end), end_(end), block_(block) {}

    /// Blocks begin at a facet, apart from the first one.
    void read(bool in_solid) {
        for (skip_space(); p_ < limit_; skip_space()) {
            if (in_solid && is_word(p_, "facet")) {
                if (!read_facet()) return;
            } else if (!in_solid && is_word(p_, "solid")) {
                p_ = next_line(p_, end_);  // its name is anything
                in_solid = true;
            } else if (in_solid && is_word(p_, "endsolid")) {
                p_ = next_line(p_, end_);
                in_solid = false;
            } else {
                fail(in_solid ? "'facet' or 'endsolid'" : "'solid'");
                return;
            }
        }
        block_.ends_in_solid = in_solid;
    }

  private:
    void skip_space() noexcept {
        while (p_ < end_ && (is_blank(*p_) || *p_ == '\n')) ++p_;
    }

    bool fail(const std::string& expected) {
        block_.fault = Fault{ErrorCode::file_format, p_,
                             expected + " should stand here, not " +
                                 (p_ >= end_ ? "the end of the file; it is truncated" : quoted_word(p_))};
        return false;
    }

    bool expect(std::string_view word) {
        skip_space();
        if (p_ >= end_ || !is_word(p_, word)) return fail(std::string("'").append(word).append("'"));
        p_ += word.size();
        return true;
    }

    bool read_facet() {
        if (!expect("facet") || !expect("normal")) return false;
        // The corners tell the normal; what programs write here is often no number.
        for (int k = 0; k < 3; ++k) {
            skip_space();
            skip_word(p_);
        }
        if (!expect("outer") || !expect("loop")) return false;
        for (int i = 0; i < 3; ++i) {
            if (!expect("vertex") || !read_corner()) return false;
        }
        return expect("endloop") && expect("endfacet");
    }

    bool read_corner() {
        double x[3];
        for (double& coordinate : x) {
            skip_space();
            if (p_ >= end_ || !take_real(p_, end_, coordinate)) return fail("a coordinate");
        }
        if (!std::isfinite(x[0]) || !std::isfinite(x[1]) || !std::isfinite(x[2])) {
            block_.fault = Fault{ErrorCode::invalid_mesh, p_, {}};  // the number of the face is known later only
            return false;
        }
        block_.corners.insert(block_.corners.end(), x, x + 3);
        return true;
    }

    const char* p_;
    const char* limit_;
    const char* end_;
    Block& block_;
};

/// Moves the cuts forward to lines that begin with "facet".
std::vector<TextBlock> cut_at_facets(const FileContents& file) {
    std::vector<TextBlock> blocks = cut_text(file.begin(), file.end());
    std::vector<TextBlock> result;
    for (const TextBlock& block : blocks) {
        const char* p = block.begin;
        for (; p < block.end && p != file.begin(); p = next_line(p, file.end())) {
            const char* word = p;
            skip_blanks(word);
            if (is_word(word, "facet")) break;
        }
        if (p < block.end) result.push_back({p, file.end(), 0});
        if (p < block.end && result.size() > 1) result[result.size() - 2].end = p;
    }
    return result;
}

Fault bad_facet(const char* where, std::size_t face, std::size_t vertex) {
    return {ErrorCode::invalid_mesh, where,
            "vertex " + std::to_string(vertex) + " of face " + std::to_string(face) +
                " (counted from 0) has a coordinate that is NaN, infinite or too large; repair the mesh"};
}

/// Corners of all blocks, in order.
std::vector<double> collect(const FileContents& file, const std::vector<TextBlock>& texts, std::vector<Block>& blocks,
                            const runtime::RunControl& control) {
    std::vector<std::size_t> first(blocks.size());
    bool in_solid = true;
    std::size_t numbers = 0;
    for (std::size_t b = 0; b < blocks.size(); ++b) {
        if (!in_solid) {
            file.fail_at_line({ErrorCode::file_format, texts[b].begin, "'solid' should stand here, not 'facet'"});
        }
        first[b] = numbers;
        numbers += blocks[b].corners.size();
        if (blocks[b].fault) {
            Fault fault = *blocks[b].fault;
            if (fault.text.empty()) fault = bad_facet(fault.where, numbers / 9, numbers / 3 % 3);
            file.fail_at_line(fault);
        }
        in_solid = blocks[b].ends_in_solid;
    }
    if (in_solid) {
        file.fail_at_line({ErrorCode::file_format, file.end(), "the file ends without 'endsolid'; it is truncated"});
    }
    if (numbers / 3 > largest_count) {
        file.fail(ErrorCode::file_format, "has more corners than 32-bit indices can name");
    }
    std::vector<double> corners;
    polled_resize(corners, numbers, control);
    runtime::parallel_for(blocks.size(), 1, [&](std::size_t b) {
        control.check();
        std::copy(blocks[b].corners.begin(), blocks[b].corners.end(),
                  corners.begin() + static_cast<std::ptrdiff_t>(first[b]));
        blocks[b].corners = {};
    });
    return corners;
}

}  // namespace

Mesh read_stl_ascii(const FileContents& file, const runtime::RunControl& control) {
    const std::vector<TextBlock> texts = cut_at_facets(file);
    std::vector<Block> blocks(texts.size());
    runtime::parallel_for(texts.size(), 1, [&](std::size_t b) {
        control.check();
        FacetReader(texts[b], file.end(), blocks[b]).read(b > 0);
    });
    const std::vector<double> corners = collect(file, texts, blocks, control);
    Weld welded = weld(
        corners.size() / 3, [&](std::size_t corner) { return position_key(&corners[3 * corner]); }, control);
    Mesh mesh;
    mesh.triangles = std::move(welded.vertex_of);
    mesh.file_faces = mesh.triangles.size() / 3;
    mesh.welded_vertices = mesh.triangles.size() - welded.first_corner.size();
    constexpr std::size_t grain = 65536;
    polled_resize(mesh.positions, 3 * welded.first_corner.size(), control);
    runtime::parallel_blocks(welded.first_corner.size(), grain, [&](std::size_t begin, std::size_t end) {
        control.check();
        for (std::size_t v = begin; v < end; ++v) {
            std::copy_n(&corners[3 * std::size_t{welded.first_corner[v]}], 3, &mesh.positions[3 * v]);
        }
    });
    return mesh;
}

}  // namespace quadseg::io
