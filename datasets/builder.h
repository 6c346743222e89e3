// Meshes a solid from rings and caps between closed loops of vertices. A loop runs counter-clockwise around the local
// z axis; a chain of rings runs from the axis at the top outwards, down, and inwards at the bottom, and then every
// triangle faces outwards: (direction of the chain) × (direction of the loop) is the outer normal.
#pragma once

#include "datasets/generate.h"
#include "math/vec3.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace quadseg::datasets {

using Loop = std::vector<std::uint32_t>;

class Builder {
  public:
    /// `spacing`: wanted edge length along loops; `row_spacing`: across them. A counting builder makes no mesh, only
    /// its number of faces.
    Builder(double spacing, double row_spacing, bool counting, std::uint64_t seed)
        : spacing_(spacing), row_spacing_(row_spacing), counting_(counting), seed_(seed) {}

    double spacing() const noexcept { return spacing_; }
    bool counting() const noexcept { return counting_; }
    std::size_t faces() const noexcept { return counting_ ? counted_ : truth_.size(); }

    /// Steps of about the wanted edge length along a loop, at least `minimum`.
    std::uint32_t steps(double length, std::uint32_t minimum = 1) const {
        return std::max(minimum, static_cast<std::uint32_t>(std::lround(length / spacing_)));
    }
    std::uint32_t rows(double length, std::uint32_t minimum = 1) const {
        return std::max(minimum, static_cast<std::uint32_t>(std::lround(length / row_spacing_)));
    }

    void reserve(std::size_t faces) {
        if (counting_) return;
        positions_.reserve(3 * (faces / 2 + 64));
        triangles_.reserve(3 * faces);
        truth_.reserve(faces);
    }
    std::int32_t add_surface(const Surface& surface) {
        surfaces_.push_back({surface, 0, 0, 0});
        return static_cast<std::int32_t>(surfaces_.size()) - 1;
    }
    std::uint32_t add_vertex(const Vec3& p) {
        if (counting_) return 0;
        positions_.insert(positions_.end(), {p.x, p.y, p.z});
        return static_cast<std::uint32_t>(positions_.size() / 3) - 1;
    }
    Vec3 position(std::uint32_t v) const {
        if (counting_) return {};
        return {positions_[3 * std::size_t{v}], positions_[3 * std::size_t{v} + 1], positions_[3 * std::size_t{v} + 2]};
    }
    template <class Point>
    Loop add_loop(std::size_t count, const Point& point) {
        Loop loop(count);
        for (std::size_t i = 0; i < count; ++i)
            loop[i] = add_vertex(counting_ ? Vec3{} : point(static_cast<double>(i)));
        return loop;
    }

    void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::int32_t surface) {
        if (counting_) {
            ++counted_;
            return;
        }
        triangles_.insert(triangles_.end(), {a, b, c});
        truth_.push_back(surface);
    }
    /// Corners counter-clockwise; cut along the shorter diagonal.
    void add_quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d, std::int32_t surface) {
        if (squared_norm(position(a) - position(c)) <= squared_norm(position(b) - position(d))) {
            add_triangle(a, b, c, surface);
            add_triangle(a, c, d, surface);
        } else {
            add_triangle(a, b, d, surface);
            add_triangle(b, c, d, surface);
        }
    }

    /// Rows of quads from loop `inner` to loop `outer`, of the same length. point(s, t): s in loop steps, t in 0 … 1
    /// from inner to outer, exact on the surface. surface(i): of the column between i and i + 1. Interior vertices are
    /// placed a little irregularly, along the loop only where both columns belong to one surface.
    template <class Point, class SurfaceOf>
    void ring(const Loop& inner, const Loop& outer, std::uint32_t rows, const Point& point, const SurfaceOf& surface) {
        const std::size_t n = inner.size();
        if (counting_) {
            counted_ += 2 * n * rows;
            return;
        }
        Loop previous = inner;
        Loop current(n);
        for (std::uint32_t row = 1; row <= rows; ++row) {
            if (row == rows) {
                current = outer;
            } else {
                for (std::size_t i = 0; i < n; ++i) {
                    const bool free = surface(i) == surface((i + n - 1) % n);
                    const double s = static_cast<double>(i) + (free ? jitter() : 0);
                    current[i] = add_vertex(point(s, (row + jitter() / 2) / rows));
                }
            }
            for (std::size_t i = 0; i < n; ++i) {
                const std::size_t k = i + 1 == n ? 0 : i + 1;
                add_quad(previous[i], current[i], current[k], previous[k], surface(i));
            }
            previous.swap(current);
        }
    }
    /// The same with straight rulings between the loops: for rings in a plane.
    void flat_ring(const Loop& inner, const Loop& outer, std::uint32_t rows, std::int32_t surface);

    /// Closes a loop of 4n vertices (2(nx + ny) with `nx` given) by a grid. point(u, v) with u, v in −1 … 1.
    /// surface(i, j): of a cell.
    template <class Point, class SurfaceOf>
    void cap(const Loop& loop, std::size_t nx, const Point& point, const SurfaceOf& surface, bool irregular = true) {
        const std::size_t ny = loop.size() / 2 - nx;
        if (counting_) {
            counted_ += 2 * nx * ny;
            return;
        }
        const auto on_loop = [&](std::size_t i, std::size_t j) {
            if (j == 0) return loop[i];
            if (i == nx) return loop[nx + j];
            if (j == ny) return loop[2 * nx + ny - i];
            return loop[(2 * nx + 2 * ny - j) % loop.size()];
        };
        Loop previous(nx + 1);
        Loop current(nx + 1);
        for (std::size_t i = 0; i <= nx; ++i) previous[i] = on_loop(i, 0);
        for (std::size_t j = 1; j <= ny; ++j) {
            for (std::size_t i = 0; i <= nx; ++i) {
                if (i == 0 || i == nx || j == ny) {
                    current[i] = on_loop(i, j);
                    continue;
                }
                // The middle stays: it is the apex of a cone, the pole of a dome.
                const bool middle = 2 * i == nx && 2 * j == ny;
                const double u = 2 * static_cast<double>(i) / static_cast<double>(nx) - 1;
                const double v = 2 * static_cast<double>(j) / static_cast<double>(ny) - 1;
                // In the corners a loop that goes straight on leaves no room.
                const double room = irregular && !middle ? 1 - std::abs(u * v) : 0;
                const double du = room * jitter();
                const double dv = room * jitter();
                current[i] =
                    add_vertex(point(u + 2 * du / static_cast<double>(nx), v + 2 * dv / static_cast<double>(ny)));
            }
            const bool outer_row = j == 1 || j == ny;
            for (std::size_t i = 0; i < nx; ++i) {
                const std::uint32_t a = previous[i], b = previous[i + 1], c = current[i + 1], d = current[i];
                const std::int32_t own = surface(i, j - 1);
                // Where two sides of the grid meet, the loop may go straight on: cut through that corner.
                const bool first_diagonal = (j == 1 && i == 0) || (j == ny && i + 1 == nx);
                if (!outer_row || (i != 0 && i + 1 != nx)) {
                    add_quad(a, b, c, d, own);
                } else if (first_diagonal) {
                    add_triangle(a, b, c, own);
                    add_triangle(a, c, d, own);
                } else {
                    add_triangle(a, b, d, own);
                    add_triangle(b, c, d, own);
                }
            }
            previous.swap(current);
        }
    }

    /// The finished mesh with counts, areas and equal surfaces joined. Leaves the builder empty.
    Generated take();

  private:
    /// In −0.2 … 0.2 of a step, a hash of the seed and the number of draws so far.
    double jitter() noexcept {
        std::uint64_t z = (seed_ + ++draws_) * 0x9E3779B97F4A7C15ULL;
        z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9ULL;
        z = (z ^ (z >> 27U)) * 0x94D049BB133111EBULL;
        return (static_cast<double>((z ^ (z >> 31U)) >> 11U) * 0x1p-53 - 0.5) * 0.4;
    }

    double spacing_;
    double row_spacing_;
    bool counting_;
    std::uint64_t seed_;
    std::uint64_t draws_ = 0;
    std::size_t counted_ = 0;
    std::vector<double> positions_;
    std::vector<std::uint32_t> triangles_;
    std::vector<std::int32_t> truth_;
    std::vector<TrueSurface> surfaces_;
};

}  // namespace quadseg::datasets
