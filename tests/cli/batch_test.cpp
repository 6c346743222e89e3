// Batches: what is done is done once, whatever happens to the program or to a mesh.
#include "tests/cli/program.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <map>
#include <random>
#include <set>
#include <thread>
#include <vector>

namespace quadseg::cli_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using namespace std::chrono_literals;

/// The program under way.
class Running {
  public:
    explicit Running(std::vector<std::string> words) {
        words.insert(words.begin(), QUADSEG_PROGRAM);
        std::vector<char*> arguments;
        for (std::string& word : words) arguments.push_back(word.data());
        arguments.push_back(nullptr);
        process_ = fork();
        if (process_ == 0) {
            const int nothing = open("/dev/null", O_RDWR);
            dup2(nothing, STDOUT_FILENO);
            dup2(nothing, STDERR_FILENO);
            execv(QUADSEG_PROGRAM, arguments.data());
            _exit(127);
        }
    }
    ~Running() {
        if (process_ > 0) {
            kill(process_, SIGKILL);
            waitpid(process_, nullptr, 0);
        }
    }
    Running(const Running&) = delete;
    Running& operator=(const Running&) = delete;

    pid_t process() const { return process_; }
    void signal(int number) const { kill(process_, number); }
    /// Waits for its end: exit code, or −signal.
    int wait() {
        int status = 0;
        waitpid(process_, &status, 0);
        process_ = -1;
        return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    }
    bool ended() const {
        siginfo_t info{};
        return waitid(P_PID, static_cast<id_t>(process_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 && info.si_pid != 0;
    }
    /// The processes that it has started, and that run the program by now.
    std::vector<pid_t> children() const {
        std::vector<pid_t> result;
        std::ifstream list("/proc/" + std::to_string(process_) + "/task/" + std::to_string(process_) + "/children");
        for (pid_t child = 0; list >> child;) {
            const std::string command = read_text("/proc/" + std::to_string(child) + "/cmdline");
            if (command.find("segment") < 12) result.push_back(child);
        }
        return result;
    }
    /// Waits for a child that works on the mesh; −1 if there is none in time.
    pid_t child_on(const std::string& mesh) const {
        for (int tries = 0; tries < 2000; ++tries) {
            for (const pid_t child : children()) {
                const std::string command = read_text("/proc/" + std::to_string(child) + "/cmdline");
                if (command.find(mesh) != std::string::npos) return child;
            }
            std::this_thread::sleep_for(1ms);
        }
        return -1;
    }

  private:
    pid_t process_ = -1;
};

std::vector<json> records_of(const std::string& log) {
    std::vector<json> records;
    std::istringstream lines(read_text(log));
    for (std::string line; std::getline(lines, line);) records.push_back(json::parse(line));
    return records;
}

json record_of(const std::vector<json>& records, const std::string& name) {
    for (const json& record : records) {
        if (record["name"] == name) return record;
    }
    return {};
}

/// All files of an output folder with what may not differ between two runs; the log's records in the order of names.
std::map<std::string, std::string> comparable(const std::string& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        const std::string name = fs::relative(entry.path(), folder).string();
        if (entry.is_directory()) {
            files[name] = "folder";
        } else if (entry.path().extension() == ".jsonl") {
            std::multiset<std::string> lines;
            for (json record : records_of(entry.path().string())) {
                record.erase("seconds");
                record.erase("peak_bytes");
                lines.insert(record.dump());
            }
            for (const std::string& line : lines) files[name] += line + "\n";
        } else if (entry.path().filename() == "result.json") {
            files[name] = without_timings(entry.path().string()).dump();
        } else {
            files[name] = read_text(entry.path());
        }
    }
    return files;
}

class Batch : public testing::Test {
  protected:
    TemporaryFolder folder;

    std::string mesh(const std::string& name, const std::string& shape, std::size_t faces) {
        const std::string path = folder / ("meshes/" + name);
        fs::create_directories(fs::path(path).parent_path());
        EXPECT_EQ(
            run("generate " + shape + " --quiet -o " + (folder / "made") + " --faces " + std::to_string(faces)).code,
            0);
        fs::rename(folder / ("made/" + shape + ".ply"), path);
        return path;
    }
    void three_meshes() {
        mesh("a.ply", "plate", 600);
        mesh("b/c.PLY", "shaft", 600);
        mesh("b/d.ply", "plate", 900);
    }
    std::string meshes() { return folder / "meshes"; }
    std::vector<json> log(const std::string& output = "out") {
        return records_of(folder / (output + "/results.jsonl"));
    }
    std::string batch(const std::string& options, const std::string& output = "out") {
        return "batch " + meshes() + " -o " + (folder / output) + " --jobs 2 " + options;
    }
};

TEST_F(Batch, DoesAllMeshesOfAFolder) {
    three_meshes();
    std::ofstream(folder / "meshes/notes.txt") << "no mesh";
    fs::create_directories(folder / "meshes/.hidden");
    fs::copy_file(folder / "meshes/a.ply", folder / "meshes/.hidden/x.ply");
    const Outcome outcome = run(batch(""));
    ASSERT_EQ(outcome.code, 0) << outcome.output;
    EXPECT_NE(outcome.output.find("3 meshes: 3 done"), std::string::npos) << outcome.output;
    ASSERT_EQ(log().size(), 3U);
    for (const char* name : {"a.ply", "b/c.PLY", "b/d.ply"}) {
        const json record = record_of(log(), name);
        EXPECT_EQ(record["status"], "ok") << record;
        EXPECT_GT(record["regions"].get<int>(), 3);
        const std::string base = folder / ("out/" + std::string(name));
        for (const char* file : {"/labels.txt", "/result.json", "/regions.ply", "/types.ply"}) {
            EXPECT_TRUE(fs::exists(base + file)) << base << file;
        }
    }
    EXPECT_FALSE(fs::exists(folder / "out/.unfinished"));
    // The same files as by `segment`.
    ASSERT_EQ(run("segment " + (folder / "meshes/a.ply") + " --quiet -o " + (folder / "alone")).code, 0);
    EXPECT_EQ(read_text(folder / "alone/labels.txt"), read_text(folder / "out/a.ply/labels.txt"));
    EXPECT_EQ(without_timings(folder / "alone/result.json"), without_timings(folder / "out/a.ply/result.json"));
}

TEST_F(Batch, OptionsOfSegmentReachEveryMesh) {
    mesh("a.ply", "plate", 600);
    const Outcome outcome = run(batch("--regions 9 --no-write-types --features none --no-regularities --weight 0.25"));
    ASSERT_EQ(outcome.code, 0) << outcome.output;
    const json result = json::parse(read_text(folder / "out/a.ply/result.json"));
    EXPECT_EQ(result["options"]["regions"], 9);
    EXPECT_EQ(result["options"]["weight"], 0.25);
    EXPECT_EQ(result["options"]["features"], 0);
    EXPECT_EQ(result["options"]["regularities"], false);
    EXPECT_FALSE(fs::exists(folder / "out/a.ply/types.ply"));
    EXPECT_TRUE(fs::exists(folder / "out/a.ply/regions.ply"));
    EXPECT_EQ(run(batch("--detail -3", "other")).code, 2);
    EXPECT_FALSE(fs::exists(folder / "other")) << "nothing is begun with options that make no sense";
}

TEST_F(Batch, ManifestWithNames) {
    three_meshes();
    std::ofstream(folder / "meshes/list") << "# a comment\n\na.ply\nb/c.PLY\tother name\n"
                                          << (folder / "meshes/b/d.ply") << "\r\nmissing.stl\n";
    const std::string command = "batch " + (folder / "meshes/list") + " -o " + (folder / "out");
    const Outcome outcome = run(command);
    EXPECT_EQ(outcome.code, 3) << outcome.output;
    std::set<std::string> names;
    for (const json& record : log()) names.insert(record["name"].get<std::string>());
    const std::string absolute = fs::path(folder / "meshes/b/d.ply").relative_path().string();
    EXPECT_EQ(names, (std::set<std::string>{"a.ply", "other name", absolute, "missing.stl"}));
    EXPECT_EQ(record_of(log(), "missing.stl")["kind"], "input");
    EXPECT_TRUE(fs::exists(folder / "out/other name/labels.txt"));
    for (const char* bad : {"a.ply\na.ply\n", "a.ply\t../x\n", "a.ply\tx\nb/c.PLY\tx/y\n", "a.ply\tbatch.json\n"}) {
        std::ofstream(folder / "meshes/list") << bad;
        EXPECT_EQ(run(command + "2").code, 3) << bad;
    }
    EXPECT_EQ(run("batch " + (folder / "nothing") + " -o " + (folder / "out3")).code, 3);
}

TEST_F(Batch, OneBadMeshHarmsNoOther) {
    three_meshes();
    std::ofstream(folder / "meshes/bad.off") << "OFF\n3 1 0\n0 0 0\n";
    std::ofstream(folder / "meshes/empty.stl") << "";
    const Outcome outcome = run(batch("--json"));
    EXPECT_EQ(outcome.code, 3) << outcome.output;
    const json summary = json::parse(outcome.output);
    EXPECT_EQ(summary["ok"], 3);
    EXPECT_EQ(summary["kinds"]["input"], 2);
    EXPECT_NE(record_of(log(), "bad.off")["message"].get<std::string>().find("bad.off"), std::string::npos);
    EXPECT_FALSE(fs::exists(folder / "out/bad.off"));
}

TEST_F(Batch, ACrashIsIsolated) {
    three_meshes();
    mesh("slow.ply", "plate", 60000);
    Running running({"batch", meshes(), "-o", folder / "out", "--jobs", "4"});
    const pid_t child = running.child_on("slow.ply");
    ASSERT_GT(child, 0);
    kill(child, SIGSEGV);
    EXPECT_EQ(running.wait(), 1);
    const json record = record_of(log(), "slow.ply");
    EXPECT_EQ(record["kind"], "crash") << record;
    EXPECT_NE(record["message"].get<std::string>().find("SIGSEGV"), std::string::npos);
    for (const char* name : {"a.ply", "b/c.PLY", "b/d.ply"}) EXPECT_EQ(record_of(log(), name)["status"], "ok");
    // Once more, undisturbed.
    EXPECT_EQ(run(batch("--retry")).code, 0);
    EXPECT_EQ(log().size(), 5U);
    EXPECT_EQ(log().back()["name"], "slow.ply");
    EXPECT_EQ(log().back()["status"], "ok");
}

TEST_F(Batch, TimeOutKeepsThePartialResult) {
    mesh("slow.ply", "plate", 400000);
    const Outcome outcome = run(batch("--timeout 0.1"));
    EXPECT_EQ(outcome.code, 4) << outcome.output;
    const json record = record_of(log(), "slow.ply");
    EXPECT_EQ(record["status"], "partial") << record;
    EXPECT_EQ(record["kind"], "timeout");
    EXPECT_TRUE(json::parse(read_text(folder / "out/slow.ply/result.json"))["partial"].get<bool>());
}

TEST_F(Batch, AMeshThatHangsIsKilled) {
    mesh("a.ply", "plate", 600);
    mesh("slow.ply", "plate", 60000);
    Running running({"batch", meshes(), "-o", folder / "out", "--jobs", "2", "--timeout", "0.2", "--grace", "0.3"});
    const pid_t child = running.child_on("slow.ply");
    ASSERT_GT(child, 0);
    kill(child, SIGSTOP);  // it can't end by itself any more
    EXPECT_EQ(running.wait(), 3);
    EXPECT_EQ(record_of(log(), "slow.ply")["kind"], "timeout");
    EXPECT_EQ(record_of(log(), "slow.ply")["status"], "failed");
    EXPECT_EQ(kill(child, 0), -1) << "it is still there";
}

TEST_F(Batch, MemoryLimit) {
    mesh("a.ply", "plate", 600);
    mesh("large.ply", "plate", 200000);
    const Outcome outcome = run(batch("--memory-limit 30M"));
    EXPECT_NE(outcome.code, 0) << outcome.output;
    EXPECT_EQ(record_of(log(), "a.ply")["status"], "ok") << record_of(log(), "a.ply");
    EXPECT_EQ(record_of(log(), "large.ply")["kind"], "memory") << record_of(log(), "large.ply");
    const std::string message = record_of(log(), "large.ply")["message"];
    EXPECT_NE(message.find("limit is"), std::string::npos) << message;
    for (const char* bad : {"0", "much", "-1G", "5X"}) {
        EXPECT_EQ(run(batch(std::string("--memory-limit ") + bad, "x")).code, 2) << bad;
    }
}

/// Wherever in a job memory ends, that mesh alone fails, and of memory.
TEST_F(Batch, AnyMemoryLimitIsAResultOrAKind) {
    mesh("large.ply", "flange", 60000);
    std::set<std::string> seen;
    for (int megabytes = 2; megabytes <= 42; megabytes += 4) {
        const std::string output = "out" + std::to_string(megabytes);
        run(batch("--threads 4 --memory-limit " + std::to_string(megabytes) + "M", output));
        const json record = record_of(log(output), "large.ply");
        ASSERT_FALSE(record.is_null());
        const std::string outcome = record["status"] == "failed" ? record["kind"] : record["status"];
        EXPECT_TRUE(outcome == "memory" || outcome == "ok") << megabytes << " MB: " << record;
        seen.insert(outcome);
    }
    EXPECT_TRUE(seen.contains("memory"));
}

TEST_F(Batch, NamesThatAreNoUtf8) {
    mesh("a.ply", "plate", 600);
    const std::string strange = folder / "meshes/b\xff\xc3.ply";
    std::error_code error;
    fs::copy_file(folder / "meshes/a.ply", strange, error);
    if (error) GTEST_SKIP() << "this file system takes no such name";
    ASSERT_EQ(run(batch("")).code, 0);
    EXPECT_EQ(log().size(), 2U);
    const json result = json::parse(read_text(folder / "out/b\xff\xc3.ply/result.json"));
    EXPECT_NE(result["input"]["file"].get<std::string>().find("b\uFFFD"), std::string::npos);
    EXPECT_EQ(run("info --json '" + strange + "'").code, 0);
    EXPECT_EQ(run("segment '" + strange + "' --json -o " + (folder / "alone")).code, 0);
    EXPECT_EQ(run("compare --json '" + strange + "' '" + strange + "'").code, 0);
    EXPECT_EQ(run(batch("--resume --list")).output, "") << "both are done";
}

TEST_F(Batch, AnEarlierLogIsNotOverwritten) {
    three_meshes();
    ASSERT_EQ(run(batch("")).code, 0);
    const std::string before = read_text(folder / "out/results.jsonl");
    EXPECT_EQ(run(batch("")).code, 2);
    EXPECT_EQ(run(batch("--resume --regions 5")).code, 2) << "other options";
    const auto written = fs::last_write_time(folder / "out/a.ply/labels.txt");
    EXPECT_EQ(run(batch("--resume")).code, 0);
    EXPECT_EQ(read_text(folder / "out/results.jsonl"), before);
    EXPECT_EQ(fs::last_write_time(folder / "out/a.ply/labels.txt"), written);
}

TEST_F(Batch, KilledBeforeItsFirstMeshLeavesNothing) {
    three_meshes();
    ASSERT_EQ(run(batch("")).code, 0);
    const auto complete = comparable(folder / "out");
    fs::remove_all(folder / "out");
    // While the options were written down: into the folder of what is unfinished, so that they never lie beside it.
    fs::create_directories(folder / "out/.unfinished");
    std::ofstream(folder / "out/.unfinished/batch.json.tmp-1-2") << "{";
    ASSERT_EQ(run(batch("--resume --list")).code, 0);
    EXPECT_FALSE(fs::exists(folder / "out/.unfinished"));
    EXPECT_TRUE(fs::exists(folder / "out/batch.json"));
    ASSERT_EQ(run(batch("--resume")).code, 0);
    EXPECT_EQ(comparable(folder / "out"), complete);
}

TEST_F(Batch, ResumeDoesWhatIsMissingAndOnlyThat) {
    three_meshes();
    ASSERT_EQ(run(batch("")).code, 0);
    const auto complete = comparable(folder / "out");
    std::istringstream lines(read_text(folder / "out/results.jsonl"));
    std::string first;
    std::getline(lines, first);
    // Killed in the middle of writing the second record; its files may or may not be there.
    std::ofstream(folder / "out/results.jsonl", std::ios::binary) << first << "\n{\"mesh\":\"/x/a.ply\",\"na";
    const std::string done = json::parse(first)["name"];
    const auto before = fs::last_write_time(folder / ("out/" + done + "/labels.txt"));
    const Outcome listed = run(batch("--resume --list"));
    EXPECT_EQ(std::count(listed.output.begin(), listed.output.end(), '\n'), 2) << listed.output;
    ASSERT_EQ(run(batch("--resume")).code, 0);
    EXPECT_EQ(fs::last_write_time(folder / ("out/" + done + "/labels.txt")), before);
    EXPECT_EQ(comparable(folder / "out"), complete);
}

TEST_F(Batch, ShardsAreThePartsOfTheWhole) {
    three_meshes();
    ASSERT_EQ(run(batch("")).code, 0);
    for (const char* shard : {"1/2", "2/2"}) {
        ASSERT_EQ(run(batch(std::string("--shard ") + shard, "shards")).code, 0);
    }
    auto whole = comparable(folder / "out"), parts = comparable(folder / "shards");
    EXPECT_EQ(records_of(folder / "shards/results-1-of-2.jsonl").size(), 2U);
    EXPECT_EQ(records_of(folder / "shards/results-2-of-2.jsonl").size(), 1U);
    for (const char* log_name : {"results.jsonl", "results-1-of-2.jsonl", "results-2-of-2.jsonl"}) {
        whole.erase(log_name);
        parts.erase(log_name);
    }
    EXPECT_EQ(whole, parts);
    for (const char* bad : {"0/2", "3/2", "1", "1/0", "a/b", "1/2x"}) {
        EXPECT_EQ(run(batch(std::string("--shard ") + bad, "x")).code, 2) << bad;
    }
}

TEST_F(Batch, StoppedBySignalAndResumed) {
    three_meshes();
    mesh("slow.ply", "plate", 60000);
    const auto start = std::chrono::steady_clock::now();
    Running running({"batch", meshes(), "-o", folder / "out", "--jobs", "4"});
    const pid_t child = running.child_on("slow.ply");
    ASSERT_GT(child, 0);
    {
        // Nobody else may work in this folder meanwhile.
        const Outcome second = run(batch("--resume"));
        EXPECT_EQ(second.code, 2) << second.output;
    }
    running.signal(SIGTERM);
    EXPECT_EQ(running.wait(), 4);
    EXPECT_LT(std::chrono::steady_clock::now() - start, 20s);
    EXPECT_EQ(kill(child, 0), -1) << "a worker goes on";
    EXPECT_TRUE(record_of(log(), "slow.ply").is_null());
    EXPECT_FALSE(fs::exists(folder / "out/slow.ply"));
    EXPECT_EQ(run(batch("--resume")).code, 0);
    EXPECT_EQ(log().size(), 4U);
}

TEST_F(Batch, KilledAtRandomMomentsAndResumedEqualsUndisturbed) {
    // QUADSEG_KILLS: how many times (the long tier says 50).
    const char* wanted = std::getenv("QUADSEG_KILLS");
    int kills = wanted ? std::atoi(wanted) : 5;
    for (int k = 0; k < 6; ++k)
        mesh(std::string("m").append(std::to_string(k)).append(".ply"), k % 2 == 0 ? "plate" : "shaft", 500 + 100 * k);
    std::ofstream(folder / "meshes/bad.off") << "OFF\n3 1 0\n0 0 0\n";
    const auto start = std::chrono::steady_clock::now();
    ASSERT_EQ(run(batch("")).code, 3);
    const std::chrono::duration<double> undisturbed = std::chrono::steady_clock::now() - start;
    const auto expected = comparable(folder / "out");

    std::mt19937 random(kills);
    int round = 0;
    int hits = 0;
    while (kills > 0) {
        const std::string output = "killed" + std::to_string(round++);
        while (true) {
            Running running({"batch", meshes(), "-o", folder / output, "--jobs", "2", "--resume"});
            if (kills > 0) {
                --kills;
                std::this_thread::sleep_for(undisturbed * (static_cast<double>(random() % 1000) / 1000));
                running.signal(SIGKILL);
            }
            const int code = running.wait();
            hits += code == -SIGKILL ? 1 : 0;
            if (code == 3) break;
            ASSERT_EQ(code, -SIGKILL);
        }
        ASSERT_EQ(comparable(folder / output), expected) << "round " << round;
        fs::remove_all(folder / output);
    }
    EXPECT_GT(hits, 0);
    RecordProperty("killed", hits);
}

}  // namespace
}  // namespace quadseg::cli_test
