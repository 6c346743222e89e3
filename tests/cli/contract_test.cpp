// The contract of the program: flags, files, keys, exit codes.
#include "tests/cli/program.h"

#include <gtest/gtest.h>
#include <map>
#include <set>
#include <vector>

namespace quadseg::cli_test {
namespace {

class Contract : public testing::Test {
  protected:
    TemporaryFolder folder;

    std::string plate(std::size_t faces = 1500) {
        EXPECT_EQ(run("generate plate --quiet -o " + (folder / "") + " --faces " + std::to_string(faces)).code, 0);
        return folder / "plate.ply";
    }
    std::string write(const std::string& name, const std::string& text) {
        std::ofstream(folder / name, std::ios::binary) << text;
        return folder / name;
    }
};

TEST_F(Contract, SegmentWritesItsFiles) {
    const Outcome outcome = run("segment " + plate() + " -o " + (folder / "out") + " --pictures --project");
    ASSERT_EQ(outcome.code, 0) << outcome.output;
    for (const char* name : {"out/labels.txt", "out/result.json", "out/regions.ply", "out/types.ply",
                             "out/projected.ply", "out/regions.png", "out/types.png"}) {
        EXPECT_TRUE(std::filesystem::file_size(folder / name) > 0) << name;
    }
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder / "out"), {}), 7) << "something is left over";

    const auto json = nlohmann::ordered_json::parse(read_text(folder / "out/result.json"));
    std::vector<std::string> keys;
    for (const auto& [key, value] : json.items()) keys.push_back(key);
    EXPECT_EQ(keys.front(), "quadseg");
    for (const char* key : {"input", "options", "stop", "energy", "rms", "max", "seconds", "threads", "peak_bytes",
                            "regions", "partial"}) {
        EXPECT_TRUE(json.contains(key)) << key;
    }
    for (const char* key : {"file", "faces", "vertices", "components", "diagonal", "repairs"}) {
        EXPECT_TRUE(json["input"].contains(key)) << key;
    }
    for (const char* key : {"read", "prepare", "coarse", "fine", "post", "write", "total"}) {
        EXPECT_TRUE(json["seconds"].contains(key)) << key;
    }

    std::istringstream labels(read_text(folder / "out/labels.txt"));
    std::map<int, std::size_t> faces_of;
    std::size_t count = 0;
    for (int label = 0; labels >> label; ++count) ++faces_of[label];
    EXPECT_EQ(count, json["input"]["faces"].get<std::size_t>());
    ASSERT_EQ(faces_of.size(), json["regions"].size());
    const std::map<std::string, std::set<std::string>> parameters{
        {"plane", {"normal", "offset"}},
        {"sphere", {"center", "radius"}},
        {"cylinder", {"axis_point", "axis", "radius"}},
        {"cone", {"apex", "axis", "half_angle"}},
        {"torus", {"center", "axis", "major_radius", "minor_radius"}}};
    for (const auto& region : json["regions"]) {
        EXPECT_EQ(faces_of[region["id"].get<int>()], region["faces"].get<std::size_t>());
        EXPECT_EQ(region["coefficients"].size(), 10U);
        std::set<std::string> names;
        for (const auto& [key, value] : region["parameters"].items()) names.insert(key);
        const auto expected = parameters.find(region["type"].get<std::string>());
        if (expected != parameters.end()) {
            EXPECT_EQ(names, expected->second) << region["type"];
        }
    }
}

TEST_F(Contract, ColouredMeshesCarryTheLabels) {
    ASSERT_EQ(run("segment " + plate() + " -o " + (folder / "out")).code, 0);
    const std::string ply = read_text(folder / "out/regions.ply");
    const std::string header = ply.substr(0, ply.find("end_header"));
    for (const char* line : {"binary_little_endian", "property uchar red", "property int label"}) {
        EXPECT_NE(header.find(line), std::string::npos) << header;
    }
    // What we write, we read; faces in the same order.
    ASSERT_EQ(run("segment " + (folder / "out/regions.ply") + " -o " + (folder / "again")).code, 0);
    EXPECT_EQ(read_text(folder / "out/labels.txt"), read_text(folder / "again/labels.txt"));
}

TEST_F(Contract, ThreadsDoNotChangeTheFiles) {
    const std::string mesh = plate(3000);
    for (const std::string preset : {"default", "paper --regions 40"}) {
        for (const std::string threads : {"1", "2"}) {
            const Outcome outcome = run("segment " + mesh + " -o " + (folder / threads) + " --preset " + preset +
                                        " --smooth --project --quiet --threads " + threads);
            ASSERT_EQ(outcome.code, 0) << outcome.output;
            EXPECT_EQ(outcome.output, "");
        }
        for (const std::string name : {"/labels.txt", "/regions.ply", "/types.ply", "/projected.ply"}) {
            EXPECT_EQ(read_text(folder / ("1" + name)), read_text(folder / ("2" + name))) << preset << name;
        }
        EXPECT_EQ(without_timings(folder / "1/result.json"), without_timings(folder / "2/result.json")) << preset;
    }
}

TEST_F(Contract, JsonGoesToStandardOutput) {
    const Outcome outcome = run("segment " + plate() + " -o " + (folder / "out") + " --json --quiet");
    ASSERT_EQ(outcome.code, 0);
    EXPECT_EQ(outcome.output, read_text(folder / "out/result.json"));
    const Outcome info = run("info --json " + (folder / "plate.ply"));
    ASSERT_EQ(info.code, 0);
    EXPECT_EQ(nlohmann::json::parse(info.output)["components"], 1);
}

TEST_F(Contract, UsageErrorsExitWith2) {
    const std::string mesh = plate();
    const std::string job = "segment " + mesh + " -o " + (folder / "out");
    for (const std::string& arguments :
         {std::string(), std::string("frobnicate"), "segment " + mesh, job + " --regions many", job + " --features 300",
          job + " --features sharp", job + " --coarse some", job + " --preset best", job + " --weight -1",
          job + " --tolerance nan", job + " --threads -1", job + " --timeout 0", job + " --unknown",
          "generate teapot -o " + (folder / "x"), "generate plate --faces 3 -o " + (folder / "x")}) {
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.code, 2) << arguments << '\n' << outcome.output;
        EXPECT_FALSE(outcome.output.empty()) << arguments;
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "out"));
    EXPECT_EQ(run("--help").code, 0);
    EXPECT_EQ(run("segment --help").code, 0);
}

TEST_F(Contract, UnusableInputExitsWith3AndNamesThePlace) {
    const auto expect = [&](const std::string& path, const std::string& place) {
        const Outcome outcome = run("segment " + path + " -o " + (folder / "out"));
        EXPECT_EQ(outcome.code, 3) << path << '\n' << outcome.output;
        EXPECT_NE(outcome.output.find(path), std::string::npos) << outcome.output;
        EXPECT_NE(outcome.output.find(place), std::string::npos) << outcome.output;
    };
    expect(folder / "missing.off", "No such file");
    expect(folder / "", "directory");
    expect(write("empty.off", ""), "");
    expect(write("truncated.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n"), "line");
    expect(write("garbage.obj", std::string("\x01\x02\xff\x00 nonsense", 13)), "");
    expect(write("nan.off", "OFF\n3 1 0\n0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n"), "vertex 1");
    expect(write("index.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n"), "face 0");
    expect(write("flat.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n2 0 0\n3 0 1 2\n"), "");
}

TEST_F(Contract, AMemoryLimitRefusesBeforeTheWork) {
    const std::string job = "segment " + plate(20000) + " -o " + (folder / "out");
    for (const char* limit : {"100K", "2M"}) {  // too little to read it, too little to segment it
        const Outcome outcome = run(job + " --memory-limit " + limit);
        EXPECT_EQ(outcome.code, 3) << outcome.output;
        EXPECT_NE(outcome.output.find("plate.ply"), std::string::npos) << outcome.output;
        EXPECT_NE(outcome.output.find("limit is"), std::string::npos) << outcome.output;
    }
    EXPECT_EQ(run(job + " --memory-limit much").code, 2);
    EXPECT_EQ(run(job + " --memory-limit 1G").code, 0);
}

TEST_F(Contract, OneFaceIsAMesh) {
    const std::string one = write("one.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    const Outcome outcome = run("segment " + one + " -o " + (folder / "out"));
    EXPECT_EQ(outcome.code, 0) << outcome.output;
    EXPECT_EQ(read_text(folder / "out/labels.txt"), "0\n");
}

TEST_F(Contract, NothingHalfWrittenIsLeft) {
    const std::string mesh = plate(20000);
    // Files of more than 100 KiB cannot be written, as on a full disk.
    const Outcome outcome = run("segment " + mesh + " -o " + (folder / "out"), "ulimit -f 200; trap '' XFSZ;");
    EXPECT_EQ(outcome.code, 1) << outcome.output;
    EXPECT_NE(outcome.output.find("regions.ply"), std::string::npos) << outcome.output;
    EXPECT_FALSE(std::filesystem::exists(folder / "out/regions.ply"));
    EXPECT_FALSE(std::filesystem::exists(folder / "out/types.ply"));
    EXPECT_FALSE(std::filesystem::exists(folder / "out/result.json"));
    for (const auto& entry : std::filesystem::directory_iterator(folder / "out")) {
        EXPECT_EQ(entry.path().filename(), "labels.txt");
    }
    const Outcome no_folder = run("segment " + mesh + " -o " + mesh + "/out");
    EXPECT_EQ(no_folder.code, 1) << no_folder.output;
}

TEST_F(Contract, ATimeoutGivesAPartialResult) {
    const std::string mesh = plate(30000);
    const Outcome outcome =
        run("segment " + mesh + " -o " + (folder / "out") + " --preset paper --regions 100 --timeout 0.2");
    ASSERT_EQ(outcome.code, 4) << outcome.output;
    const auto json = nlohmann::json::parse(read_text(folder / "out/result.json"));
    EXPECT_EQ(json["partial"], true);
    EXPECT_EQ(json["stop"], "deadline");
    std::istringstream labels(read_text(folder / "out/labels.txt"));
    std::size_t count = 0;
    for (int label = 0; labels >> label; ++count) EXPECT_GE(label, 0);
    EXPECT_EQ(count, json["input"]["faces"].get<std::size_t>());
}

TEST_F(Contract, ASignalGivesAPartialResult) {
    const std::string mesh = plate(30000);
    for (const std::string signal : {"INT", "TERM"}) {
        const std::string out = folder / signal;
        // The shell's background jobs ignore SIGINT; timeout(1) does not.
        const Outcome outcome = run("segment " + mesh + " -o " + out + " --preset paper --regions 200",
                                    "timeout --preserve-status -s " + signal + " 0.4");
        ASSERT_EQ(outcome.code, 4) << outcome.output;
        EXPECT_EQ(nlohmann::json::parse(read_text(out + "/result.json"))["stop"], "cancelled");
    }
}

TEST_F(Contract, ProgressIsLinesWhereThereIsNoTerminal) {
    const std::string job = "segment " + plate() + " -o " + (folder / "out");
    const Outcome always = run(job + " --progress always");
    EXPECT_NE(always.output.find("quadseg: "), std::string::npos) << always.output;
    EXPECT_EQ(always.output.find('\r'), std::string::npos);
    const Outcome never = run(job + " --progress never");
    EXPECT_EQ(never.output.find("quadseg: "), std::string::npos) << never.output;
}

TEST_F(Contract, PolygonsShareALabel) {
    const std::string cube = write("cube.obj",
                                   "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
                                   "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
    ASSERT_EQ(run("segment " + cube + " -o " + (folder / "out")).code, 0);
    std::istringstream labels(read_text(folder / "out/labels.txt"));
    std::vector<int> all;
    for (int label = 0; labels >> label;) all.push_back(label);
    EXPECT_EQ(all.size(), 6U) << "one line a face of the file";
}

TEST_F(Contract, SimplifyReachesItsTarget) {
    const Outcome outcome = run("simplify " + plate(20000) + " -o " + (folder / "small.off") + " --faces 2000");
    ASSERT_EQ(outcome.code, 0) << outcome.output;
    const Outcome info = run("info --json " + (folder / "small.off"));
    ASSERT_EQ(info.code, 0) << info.output;
    const auto json = nlohmann::json::parse(info.output);
    EXPECT_NEAR(json["faces"].get<double>(), 2000, 100);
    EXPECT_EQ(json["border_edges"], 0);
}

TEST_F(Contract, GenerateWritesMeshAndTruth) {
    const Outcome outcome =
        run("generate flange -o " + (folder / "made") + " --faces 2000 --noise 0.001 --seed 3 --shuffle --off");
    ASSERT_EQ(outcome.code, 0) << outcome.output;
    const auto truth = nlohmann::json::parse(read_text(folder / "made/flange.gt.json"));
    const Outcome info = run("info --json " + (folder / "made/flange.ply"));
    const auto faces = nlohmann::json::parse(info.output)["faces"].get<std::size_t>();
    EXPECT_EQ(truth["surface_group"].size(), faces);
    EXPECT_EQ(truth["brep_face"].size(), faces);
    EXPECT_EQ(truth["triangles"].get<std::size_t>(), faces);
    EXPECT_FALSE(truth["group_adjacency"].empty());
    EXPECT_EQ(truth["groups"].size(), truth["faces"].size());
    EXPECT_EQ(nlohmann::json::parse(run("info --json " + (folder / "made/flange.off")).output)["faces"], faces);
}

}  // namespace
}  // namespace quadseg::cli_test
