#include "datasets/generate.h"

#include <quadseg/error.h>

#include "datasets/shapes.h"

#include <array>
#include <utility>

namespace quadseg::datasets {
namespace {

struct Entry {
    const char* name;
    Shape shape;
};
constexpr std::array shapes{
    Entry{"plate", make_plate},     Entry{"shaft", make_shaft},
    Entry{"flange", make_flange},   Entry{"quadrics", make_quadrics},
    Entry{"fillets", make_fillets}, Entry{"rounded_octahedron", make_rounded_octahedron},
};

struct Spacing {
    double along;   ///< loops
    double across;  ///< rows
};

/// The edge length that gives about the wanted number of faces: bisection on both spacings, then on the rows alone,
/// whose number is finer to choose.
Spacing find_spacing(Shape shape, const Recipe& recipe) {
    const auto count = [&](const Spacing& spacing) {
        Builder builder(spacing.along, spacing.across, true, recipe.seed);
        shape(builder, Pcg(recipe.seed));
        return builder.faces();
    };
    const auto error = [&](const Spacing& spacing) {
        const double ratio = static_cast<double>(count(spacing)) / static_cast<double>(recipe.faces);
        return std::max(ratio, 1 / ratio);
    };
    Spacing best{1, 1};
    double best_error = error(best);
    const auto bisect = [&](double low, double high, const auto& make) {
        for (int step = 0; step < 40; ++step) {
            const double middle = std::sqrt(low * high);
            const Spacing spacing = make(middle);
            if (const double e = error(spacing); e < best_error) {
                best = spacing;
                best_error = e;
            }
            (count(spacing) > recipe.faces ? low : high) = middle;
            if (best_error < 1.01 || high / low < 1.0001) break;
        }
    };
    bisect(1e-3, 100, [](double x) { return Spacing{x, x}; });
    const double along = best.along;
    if (best_error > 1.01) bisect(along / 3, along * 3, [along](double x) { return Spacing{along, x}; });
    return best;
}

void add_noise(Mesh& mesh, double sigma, Pcg random) {
    std::vector<Vec3> normals(mesh.positions.size() / 3);
    const auto at = [&](std::uint32_t v) {
        const std::size_t i = 3 * std::size_t{v};
        return Vec3{mesh.positions[i], mesh.positions[i + 1], mesh.positions[i + 2]};
    };
    for (std::size_t f = 0; f < mesh.triangles.size(); f += 3) {
        const std::uint32_t* t = &mesh.triangles[f];
        const Vec3 normal = cross(at(t[1]) - at(t[0]), at(t[2]) - at(t[0]));
        for (int k = 0; k < 3; ++k) normals[t[k]] += normal;
    }
    for (std::size_t v = 0; v < normals.size(); ++v) {
        const Vec3 shift = normalized(normals[v]) * (sigma * random.gaussian());
        for (int a = 0; a < 3; ++a) mesh.positions[3 * v + static_cast<std::size_t>(a)] += shift[a];
    }
}

std::vector<std::uint32_t> random_order(std::size_t count, Pcg& random) {
    std::vector<std::uint32_t> order(count);
    for (std::size_t i = 0; i < count; ++i) order[i] = static_cast<std::uint32_t>(i);
    for (std::size_t i = count; i > 1; --i) std::swap(order[i - 1], order[random.below(static_cast<std::uint32_t>(i))]);
    return order;
}

void shuffle(Generated& generated, Pcg random) {
    Mesh& mesh = generated.mesh;
    const auto new_place = random_order(mesh.positions.size() / 3, random);
    std::vector<double> positions(mesh.positions.size());
    for (std::size_t v = 0; v < new_place.size(); ++v) {
        for (std::size_t a = 0; a < 3; ++a) positions[3 * std::size_t{new_place[v]} + a] = mesh.positions[3 * v + a];
    }
    mesh.positions = std::move(positions);
    const auto source = random_order(generated.truth.size(), random);
    std::vector<std::uint32_t> triangles(mesh.triangles.size());
    std::vector<std::int32_t> truth(generated.truth.size());
    for (std::size_t f = 0; f < source.size(); ++f) {
        for (std::size_t k = 0; k < 3; ++k) {
            triangles[3 * f + k] = new_place[mesh.triangles[3 * std::size_t{source[f]} + k]];
        }
        truth[f] = generated.truth[source[f]];
    }
    mesh.triangles = std::move(triangles);
    generated.truth = std::move(truth);
}

}  // namespace

std::vector<std::string> generator_names() {
    std::vector<std::string> names;
    for (const Entry& entry : shapes) names.emplace_back(entry.name);
    return names;
}

Generated generate(const Recipe& recipe) {
    Shape shape = nullptr;
    std::string known;
    for (const Entry& entry : shapes) {
        if (recipe.name == entry.name) shape = entry.shape;
        known += (known.empty() ? "" : ", ") + std::string(entry.name);
    }
    if (shape == nullptr) {
        throw Error(ErrorCode::invalid_argument, "no generator is called '" + recipe.name + "'; there are " + known);
    }
    if (recipe.faces < 500 || recipe.faces > 50'000'000) {
        throw Error(ErrorCode::invalid_argument,
                    "faces must be 500 to 50000000, but is " + std::to_string(recipe.faces));
    }
    if (!(recipe.noise >= 0 && recipe.noise <= 0.1)) {
        throw Error(ErrorCode::invalid_argument, "noise must be 0 to 0.1, but is " + std::to_string(recipe.noise));
    }
    const Spacing spacing = find_spacing(shape, recipe);
    Builder builder(spacing.along, spacing.across, false, recipe.seed);
    builder.reserve(recipe.faces + recipe.faces / 8);
    shape(builder, Pcg(recipe.seed));
    Generated generated = builder.take();
    if (recipe.noise > 0) add_noise(generated.mesh, recipe.noise * generated.diagonal, Pcg(recipe.seed, 2));
    if (recipe.shuffle) shuffle(generated, Pcg(recipe.seed, 3));
    return generated;
}

Generated generate(const std::string& name, std::size_t faces, double noise, std::uint64_t seed) {
    return generate(Recipe{name, faces, noise, seed, false});
}

}  // namespace quadseg::datasets
