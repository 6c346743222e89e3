#include "tools/cli/rasterizer.h"

#include "math/vec3.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace quadseg::cli {
namespace {

constexpr std::int32_t background = -2;
constexpr std::size_t oversampling = 2;

Vec3 vertex(const MeshView& mesh, std::uint32_t v) {
    const std::size_t i = 3 * std::size_t{v};
    return {mesh.positions[i], mesh.positions[i + 1], mesh.positions[i + 2]};
}

/// Orthographic; x right, y down in samples, depth towards the viewer.
struct Camera {
    Vec3 right, down, towards;
    Vec3 origin;
    double scale = 1, shift_x = 0, shift_y = 0;

    Vec3 project(const Vec3& p) const {
        const Vec3 d = p - origin;
        return {dot(d, right) * scale + shift_x, dot(d, down) * scale + shift_y, dot(d, towards) * scale};
    }
};

Camera look_at(const MeshView& mesh, int upright, double width, double height) {
    Vec3 low = vertex(mesh, mesh.triangles.empty() ? 0 : mesh.triangles[0]);
    Vec3 high = low;
    for (const std::uint32_t v : mesh.triangles) {
        const Vec3 p = vertex(mesh, v);
        for (int a = 0; a < 3; ++a) {
            low[a] = std::min(low[a], p[a]);
            high[a] = std::max(high[a], p[a]);
        }
    }
    const Vec3 extent = high - low;
    // The shortest side of the box stands upright, z if there is a choice; the longest runs to the right.
    int up = 2;
    for (const int a : {1, 0}) {
        if (extent[a] < 0.8 * extent[up]) up = a;
    }
    if (upright >= 0) up = upright;
    const int side = (up + 1) % 3;
    const int back = (up + 2) % 3;
    const bool turned = extent[back] > extent[side];
    Vec3 x;
    Vec3 y;
    Vec3 z;
    z[up] = 1;
    x[turned ? back : side] = 1;
    y[turned ? side : back] = turned ? -1 : 1;

    Camera camera;
    camera.towards = normalized(x * -0.38 - y * 0.72 + z * 0.72);
    camera.right = normalized(cross(z, camera.towards));
    camera.down = cross(camera.right, camera.towards);
    camera.origin = (low + high) / 2;
    double left = 0;
    double rightmost = 0;
    double top = 0;
    double bottom = 0;
    for (const std::uint32_t v : mesh.triangles) {
        const Vec3 p = camera.project(vertex(mesh, v));
        left = std::min(left, p.x);
        rightmost = std::max(rightmost, p.x);
        top = std::min(top, p.y);
        bottom = std::max(bottom, p.y);
    }
    const double margin = 0.94;
    camera.scale =
        margin * std::min(width / std::max(rightmost - left, 1e-300), height / std::max(bottom - top, 1e-300));
    camera.shift_x = width / 2 - camera.scale * (left + rightmost) / 2;
    camera.shift_y = height / 2 - camera.scale * (top + bottom) / 2;
    return camera;
}

std::int32_t label_of(const Scene& scene, std::size_t face) {
    return scene.labels.empty() ? 0 : scene.labels[face];
}

/// Normals at the corners of faces, averaged over the faces of one region around a vertex.
std::vector<std::array<float, 3>> corner_normals(const Scene& scene) {
    const MeshView& mesh = scene.mesh;
    const std::size_t corners = mesh.triangles.size();
    std::vector<std::uint32_t> order(corners);
    std::iota(order.begin(), order.end(), 0U);
    // Corners by vertex (counting sort keeps their order), then by region within the few of a vertex.
    std::vector<std::uint32_t> start(mesh.vertex_count() + 1);
    for (const std::uint32_t v : mesh.triangles) ++start[v + 1];
    std::partial_sum(start.begin(), start.end(), start.begin());
    {
        std::vector<std::uint32_t> next(start.begin(), start.end() - 1);
        for (std::uint32_t c = 0; c < corners; ++c) order[next[mesh.triangles[c]]++] = c;
    }
    std::vector<Vec3> face_normal(mesh.face_count());
    for (std::size_t f = 0; f < face_normal.size(); ++f) {
        const Vec3 a = vertex(mesh, mesh.triangles[3 * f]);
        face_normal[f] =
            cross(vertex(mesh, mesh.triangles[3 * f + 1]) - a, vertex(mesh, mesh.triangles[3 * f + 2]) - a);
    }
    std::vector<std::array<float, 3>> normals(corners);
    constexpr std::uint32_t largest_fan = 64;  // beyond, the apex of a fan: averaging has no meaning, and would be slow
    for (std::size_t v = 0; v + 1 < start.size(); ++v) {
        const bool average = start[v + 1] - start[v] <= largest_fan;
        for (std::uint32_t i = start[v]; i < start[v + 1]; ++i) {
            const std::size_t f = order[i] / 3;
            const Vec3 own = normalized(face_normal[f]);
            Vec3 sum = average ? Vec3{} : own;
            for (std::uint32_t j = start[v]; average && j < start[v + 1]; ++j) {
                const std::size_t g = order[j] / 3;
                // A crease inside a region stays a crease.
                if (label_of(scene, g) == label_of(scene, f) && dot(own, normalized(face_normal[g])) > 0.7) {
                    sum += face_normal[g];
                }
            }
            const Vec3 n = normalized(sum);
            normals[order[i]] = {static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)};
        }
    }
    return normals;
}

struct Sample {
    float depth = -std::numeric_limits<float>::infinity();
    std::int32_t label = background;
    std::array<float, 3> light{};  ///< shaded colour, 0 … 255
};

class Canvas {
  public:
    Canvas(std::size_t width, std::size_t height, const Camera& camera)
        : width_(width), height_(height), camera_(camera), samples_(width * height) {}

    void draw(const Scene& scene) {
        const auto normals = corner_normals(scene);
        for (std::size_t f = 0; f < scene.mesh.face_count(); ++f) {
            std::array<Vec3, 3> p;
            for (std::size_t k = 0; k < 3; ++k)
                p[k] = camera_.project(vertex(scene.mesh, scene.mesh.triangles[3 * f + k]));
            const std::int32_t label = label_of(scene, f);
            const Rgb color = color_of(scene, label);
            if (scene.error_shares.empty()) {
                fill(p, &normals[3 * f], label, [&](double, double, double) { return color; });
                continue;
            }
            std::array<double, 3> share{};
            for (std::size_t k = 0; k < 3; ++k) share[k] = scene.error_shares[scene.mesh.triangles[3 * f + k]];
            fill(p, &normals[3 * f], label, [&](double b0, double b1, double b2) {
                return error_color(b0 * share[0] + b1 * share[1] + b2 * share[2]);
            });
        }
        for (const Edge& edge : scene.edges) {
            draw_line(camera_.project(vertex(scene.mesh, edge[0])), camera_.project(vertex(scene.mesh, edge[1])),
                      scene.edge_width * static_cast<double>(oversampling), scene.edge_color);
        }
    }

    bool line_at(std::size_t x, std::size_t y) const {
        const Sample& here = samples_[y * width_ + x];
        bool line = false;
        const auto compare = [&](std::size_t i, std::size_t j) {
            const Sample& other = samples_[j * width_ + i];
            line =
                line || other.label != here.label ||
                (here.label != background && std::abs(other.depth - here.depth) > 0.02F * static_cast<float>(width_));
        };
        if (x > 0) compare(x - 1, y);
        if (y > 0) compare(x, y - 1);
        if (x + 1 < width_) compare(x + 1, y);
        if (y + 1 < height_) compare(x, y + 1);
        return line;
    }
    const Sample& at(std::size_t x, std::size_t y) const { return samples_[y * width_ + x]; }

  private:
    static Rgb color_of(const Scene& scene, std::int32_t label) {
        const auto i = static_cast<std::size_t>(label);
        return label >= 0 && i < scene.color_of_region.size() ? scene.color_of_region[i] : unlabelled_color;
    }

    /// A line on the surface hides what lies behind it; what lies well in front hides the line.
    void draw_line(const Vec3& from, const Vec3& to, double width, Rgb color) {
        const double length = std::max({std::abs(to.x - from.x), std::abs(to.y - from.y), 1.0});
        if (!(length < 1e6)) return;
        const auto steps = static_cast<int>(std::ceil(2 * length));
        const double nearer = 0.004 * static_cast<double>(width_);
        const double half = width / 2;
        for (int i = 0; i <= steps; ++i) {
            const Vec3 p = from + (to - from) * (static_cast<double>(i) / steps);
            const auto first_x = static_cast<std::int64_t>(std::floor(p.x - half + 0.5));
            const auto first_y = static_cast<std::int64_t>(std::floor(p.y - half + 0.5));
            for (std::int64_t y = first_y; static_cast<double>(y) < p.y + half; ++y) {
                for (std::int64_t x = first_x; static_cast<double>(x) < p.x + half; ++x) {
                    if (x < 0 || y < 0 || x >= static_cast<std::int64_t>(width_) ||
                        y >= static_cast<std::int64_t>(samples_.size() / width_)) {
                        continue;
                    }
                    Sample& sample = samples_[static_cast<std::size_t>(y) * width_ + static_cast<std::size_t>(x)];
                    if (sample.label == background || p.z + nearer < static_cast<double>(sample.depth)) continue;
                    for (std::size_t c = 0; c < 3; ++c) sample.light[c] = static_cast<float>(color[c]);
                }
            }
        }
    }

    template <class ColorAt>
    void fill(const std::array<Vec3, 3>& p, const std::array<float, 3>* normals, std::int32_t label,
              const ColorAt& color_at) {
        const double area = (p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[1].y - p[0].y) * (p[2].x - p[0].x);
        if (!(std::abs(area) > 1e-12)) return;
        const auto clamp_to = [](double x, std::size_t limit) {
            return static_cast<std::size_t>(std::clamp(x, 0.0, static_cast<double>(limit)));
        };
        const auto [x_low, x_high] = std::minmax({p[0].x, p[1].x, p[2].x});
        const auto [y_low, y_high] = std::minmax({p[0].y, p[1].y, p[2].y});
        const std::size_t x0 = clamp_to(std::ceil(x_low - 0.5), width_);
        const std::size_t x1 = clamp_to(std::floor(x_high - 0.5) + 1, width_);
        const std::size_t y0 = clamp_to(std::ceil(y_low - 0.5), height_);
        const std::size_t y1 = clamp_to(std::floor(y_high - 0.5) + 1, height_);
        for (std::size_t y = y0; y < y1; ++y) {
            for (std::size_t x = x0; x < x1; ++x) {
                const double sx = static_cast<double>(x) + 0.5;
                const double sy = static_cast<double>(y) + 0.5;
                const double b1 = ((sx - p[0].x) * (p[2].y - p[0].y) - (sy - p[0].y) * (p[2].x - p[0].x)) / area;
                const double b2 = ((p[1].x - p[0].x) * (sy - p[0].y) - (p[1].y - p[0].y) * (sx - p[0].x)) / area;
                const double b0 = 1 - b1 - b2;
                if (b0 < 0 || b1 < 0 || b2 < 0) continue;
                Sample& sample = samples_[y * width_ + x];
                const auto depth = static_cast<float>(b0 * p[0].z + b1 * p[1].z + b2 * p[2].z);
                if (depth <= sample.depth) continue;
                sample.depth = depth;
                sample.label = label;
                Vec3 normal;
                for (int a = 0; a < 3; ++a) {
                    const auto i = static_cast<std::size_t>(a);
                    normal[a] = b0 * normals[0][i] + b1 * normals[1][i] + b2 * normals[2][i];
                }
                sample.light = shade(normalized(normal), color_at(b0, b1, b2));
            }
        }
    }

    /// A key light from above left, a fill light from the right, a faint highlight; both sides of a face are lit.
    std::array<float, 3> shade(Vec3 normal, Rgb color) const {
        if (dot(normal, camera_.towards) < 0) normal = -normal;
        const Vec3 up = -camera_.down;
        const Vec3 key = normalized(camera_.towards * 0.55 - camera_.right * 0.45 + up * 0.7);
        const Vec3 fill_light = normalized(camera_.towards * 0.5 + camera_.right * 0.8 - up * 0.1);
        const double diffuse =
            0.46 + 0.5 * std::max(0.0, dot(normal, key)) + 0.2 * std::max(0.0, dot(normal, fill_light));
        const Vec3 half = normalized(key + camera_.towards);
        const double highlight = 34 * std::pow(std::max(0.0, dot(normal, half)), 40);
        std::array<float, 3> light{};
        for (std::size_t c = 0; c < 3; ++c) {
            light[c] = static_cast<float>(std::min(255.0, color[c] * std::min(1.08, diffuse) + highlight));
        }
        return light;
    }

    std::size_t width_, height_;
    Camera camera_;
    std::vector<Sample> samples_;
};

}  // namespace

void draw_scene(Image& image, std::size_t width, std::size_t height, const Scene& scene) {
    const std::size_t w = width * oversampling;
    const std::size_t h = height * oversampling;
    Canvas canvas(w, h, look_at(scene.mesh, scene.up, static_cast<double>(w), static_cast<double>(h)));
    canvas.draw(scene);
    constexpr std::array<float, 3> line_color{28, 30, 36};
    for (std::size_t y = 0; y < height; ++y) {
        for (std::size_t x = 0; x < width; ++x) {
            std::array<float, 3> sum{};
            const Rgb paper = image.at(x, y);
            for (std::size_t j = 0; j < oversampling; ++j) {
                for (std::size_t i = 0; i < oversampling; ++i) {
                    const std::size_t sx = x * oversampling + i;
                    const std::size_t sy = y * oversampling + j;
                    const Sample& sample = canvas.at(sx, sy);
                    const bool line = canvas.line_at(sx, sy);
                    for (std::size_t c = 0; c < 3; ++c) {
                        sum[c] += line                         ? line_color[c]
                                  : sample.label == background ? static_cast<float>(paper[c])
                                                               : sample.light[c];
                    }
                }
            }
            for (std::size_t c = 0; c < 3; ++c) {
                image.at(x, y)[c] = static_cast<std::uint8_t>(std::lround(sum[c] / (oversampling * oversampling)));
            }
        }
    }
}

}  // namespace quadseg::cli
