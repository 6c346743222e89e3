// Makes the meshes and the ground truth of one STEP part.
//   step_truth PART.step FOLDER NAME SOURCE
#include "step.h"

#include <Standard_Failure.hxx>
#include <cstdio>
#include <exception>
#include <stdexcept>

namespace {

using namespace step_truth;

constexpr std::size_t fewest = 5000, most = 80000;  // triangles of a dense mesh

std::uint64_t hash(const std::string& text) {  // FNV-1a
    std::uint64_t h = 0xcbf29ce484222325U;
    for (const char c : text) h = (h ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
    return h;
}

Mesh dense_mesh_of_fitting_size(const Solid& solid) {
    const std::vector<double> edges = fine_edges(solid);
    double largest = 0.016 * solid.diagonal;
    const auto expected = [&] { return expected_triangles(solid, edges, largest); };
    while (expected() < 2.0 * fewest) largest *= 0.9;
    while (expected() > 0.25 * most && largest < 0.05 * solid.diagonal) largest *= 1.1;
    if (expected() > most) throw std::runtime_error("too many small features");
    Mesh mesh = dense_mesh(solid, edges, largest);
    if (mesh.triangles.size() < fewest || mesh.triangles.size() > most)
        throw std::runtime_error(std::to_string(mesh.triangles.size()) + " triangles for " +
                                 std::to_string(expected()));
    return mesh;
}

void make(const std::string& step_file, const std::string& path, const std::string& name, const std::string& source) {
    const std::uint64_t seed = hash(name);
    const Solid solid = read_solid(step_file);
    if (solid.groups < 8) throw std::runtime_error("too simple");
    Mesh cad = tessellate(solid, 5e-4 * solid.diagonal);
    finish(solid, cad, seed);
    Mesh dense = dense_mesh_of_fitting_size(solid);
    dense.deflection = cad.deflection;
    finish(solid, dense, seed + 1);
    write_off(path + ".off", dense);
    write_truth(path + ".gt.json", name, source, solid, dense);
    write_off(path + "_cad.off", cad);
    write_truth(path + "_cad.gt.json", name, source, solid, cad);
    write_off(path + "_n01.off", with_noise(dense, 1e-3 * solid.diagonal, seed + 2));
    write_off(path + "_n05.off", with_noise(dense, 5e-3 * solid.diagonal, seed + 3));
    std::printf("%s: %zu and %zu triangles, %d groups\n", name.c_str(), dense.triangles.size(), cad.triangles.size(),
                solid.groups);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 5) {
        std::fprintf(stderr, "usage: step_truth PART.step FOLDER NAME SOURCE\n");
        return 2;
    }
    try {
        make(argv[1], std::string(argv[2]) + "/" + argv[3], argv[3], argv[4]);
        return 0;
    } catch (const std::exception& e) {
        std::fprintf(stderr, "%s: %s\n", argv[3], e.what());
    } catch (const Standard_Failure& e) {
        std::fprintf(stderr, "%s: %s\n", argv[3], e.GetMessageString());
    } catch (const std::string& e) {
        std::fprintf(stderr, "%s: %s\n", argv[3], e.c_str());
    } catch (...) {
        std::fprintf(stderr, "%s: failed\n", argv[3]);
    }
    return 1;
}
