// How a service runs jobs through the library: bounded in time, threads and memory, cancellable from another thread,
// every failure caught by kind. Makes its own meshes; returns 0 only if each job ended as it should.
#include <quadseg/error.h>
#include <quadseg/segmentation.h>

#include <cmath>
#include <cstdio>
#include <new>
#include <thread>
#include <vector>

namespace {

quadseg::Mesh make_waves(std::uint32_t n) {
    quadseg::Mesh mesh;
    for (std::uint32_t j = 0; j < n; ++j) {
        for (std::uint32_t i = 0; i < n; ++i) {
            const double x = 10.0 * i / n, y = 10.0 * j / n;
            mesh.positions.insert(mesh.positions.end(), {x, y, 0.3 * std::sin(x) * std::cos(y)});
            if (i == 0 || j == 0) continue;
            const std::uint32_t d = j * n + i, c = d - 1, b = d - n, a = b - 1;
            mesh.triangles.insert(mesh.triangles.end(), {a, b, d, a, d, c});
        }
    }
    return mesh;
}

enum class Answer { complete, partial, refused, failed };

/// What a request handler does. Nothing that happens in here ends the process.
Answer serve(const quadseg::Mesh& mesh, quadseg::Context& limits) {
    try {
        const quadseg::Segmentation result = quadseg::segment(mesh.view(), {}, &limits);
        std::printf("%zu faces: %zu regions, %s, %.3f s, %d threads\n", result.labels.size(), result.regions.size(),
                    to_string(result.stop), result.seconds.total, result.threads);
        return result.partial ? Answer::partial : Answer::complete;
    } catch (const quadseg::Error& error) {
        std::printf("%s: %s\n", to_string(error.code()), error.what());
        return error.code() == quadseg::ErrorCode::internal ? Answer::failed : Answer::refused;
    } catch (const std::bad_alloc&) {
        std::printf("out of memory\n");
        return Answer::refused;
    }
}

}  // namespace

int main() {
    const quadseg::Mesh small = make_waves(40), large = make_waves(300);

    quadseg::Context usual;
    usual.set_time_limit(60);
    usual.set_threads(2);  // two such jobs at once fill four cores
    usual.set_memory_limit(std::size_t{1} << 30);
    bool good = serve(small, usual) == Answer::complete;

    quadseg::Context hurried;
    hurried.set_time_limit(0.05);
    good = serve(large, hurried) == Answer::partial && good;

    quadseg::Context narrow;
    narrow.set_memory_limit(1 << 20);
    good = serve(large, narrow) == Answer::refused && good;

    // The client hangs up: another thread cancels.
    quadseg::Context cancelled;
    std::thread client([&] { cancelled.cancel(); });
    good = serve(large, cancelled) == Answer::partial && good;
    client.join();

    quadseg::Mesh broken = small;
    broken.triangles[5] = 1'000'000;
    good = serve(broken, usual) == Answer::refused && good;
    return good ? 0 : 1;
}
