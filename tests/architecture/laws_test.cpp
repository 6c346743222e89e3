// The laws of the house that a reader of the sources can check: directions of includes, one room that names TBB, no
// output and no exit in the library, only the standard library in public headers.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

struct Source {
    std::string path;  ///< from the root of the project
    std::string room;  ///< "engine/mesh", "simplify" …
    std::string code;  ///< comments and the contents of literals blanked
    std::vector<std::string> includes;
};

/// Blanks comments, strings and characters; lines stay lines.
std::string code_only(const std::string& text) {
    std::string out = text;
    enum { code, line, block, string, character } state = code;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i], next = i + 1 < text.size() ? text[i + 1] : '\0';
        const bool separator = i > 0 && std::isalnum(static_cast<unsigned char>(text[i - 1])) && c == '\'';
        switch (state) {
            case code:
                if (c == '/' && next == '/') state = line;
                if (c == '/' && next == '*') state = block;
                if (c == '"') state = string;
                if (c == '\'' && !separator) state = character;
                if (state == line || state == block) out[i] = ' ';
                break;
            case line:
                if (c == '\n')
                    state = code;
                else
                    out[i] = ' ';
                break;
            case block:
                if (c == '*' && next == '/') {
                    out[i] = out[i + 1] = ' ';
                    ++i;
                    state = code;
                } else if (c != '\n') {
                    out[i] = ' ';
                }
                break;
            case string:
            case character:
                if (c == '\\') {
                    out[i] = ' ';
                    if (++i < text.size()) out[i] = ' ';
                } else if (c == (state == string ? '"' : '\'')) {
                    state = code;
                } else if (c == '\n') {
                    state = code;
                } else {
                    out[i] = ' ';
                }
                break;
        }
    }
    return out;
}

std::vector<Source> read_sources(const std::string& folder) {
    std::vector<Source> sources;
    const fs::path root(QUADSEG_SOURCE_DIR);
    if (!fs::exists(root / folder)) return sources;
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
        const auto extension = entry.path().extension();
        if (extension != ".h" && extension != ".cpp") continue;
        std::ifstream in(entry.path());
        const std::string text((std::istreambuf_iterator<char>(in)), {});
        Source s;
        s.path = fs::relative(entry.path(), root).generic_string();
        const auto first = s.path.find('/'), second = s.path.find('/', first + 1);
        s.room = s.path.starts_with("engine/") ? s.path.substr(0, second) : s.path.substr(0, first);
        s.code = code_only(text);
        static const std::regex include(R"re(^[ \t]*#[ \t]*include[ \t]*([<"][^>"]+[>"]))re");
        std::size_t begin = 0;
        while (begin < text.size()) {
            const std::size_t end = std::min(text.find('\n', begin), text.size());
            const std::string line = text.substr(begin, end - begin);
            std::smatch match;
            if (std::regex_search(line, match, include)) s.includes.push_back(match[1]);
            begin = end + 1;
        }
        sources.push_back(std::move(s));
    }
    std::sort(sources.begin(), sources.end(), [](const Source& a, const Source& b) { return a.path < b.path; });
    return sources;
}

const std::vector<Source>& library() {
    static const std::vector<Source> all = [] {
        auto s = read_sources("engine");
        const auto simplify = read_sources("simplify");
        s.insert(s.end(), simplify.begin(), simplify.end());
        return s;
    }();
    return all;
}

/// The room that a quoted include names, or empty.
std::string room_of_include(const std::string& include) {
    if (include[0] != '"') return {};
    const std::string path = include.substr(1, include.size() - 2);
    const auto slash = path.find('/');
    if (slash == std::string::npos) return {};
    const std::string first = path.substr(0, slash);
    if (first == "simplify" || first == "tools" || first == "bench" || first == "tests" || first == "datasets")
        return first;
    if (first == "engine") return path.substr(0, path.find('/', slash + 1));
    return "engine/" + first;
}

/// The qualified names of the code ("std::cout"); those that are called also with a bracket ("exit(").
std::set<std::string> words(const std::string& code) {
    const auto is_word = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == ':'; };
    std::set<std::string> result;
    for (std::size_t i = 0; i < code.size();) {
        if (!is_word(code[i])) {
            ++i;
            continue;
        }
        std::size_t end = i;
        while (end < code.size() && is_word(code[end])) ++end;
        std::string word = code.substr(i, end - i);
        i = end;
        while (end < code.size() && std::isspace(static_cast<unsigned char>(code[end]))) ++end;
        result.insert(word);
        if (end < code.size() && code[end] == '(') result.insert(word + "(");
    }
    return result;
}

/// Forbidden words end in '(' for calls, in "::" for anything of a namespace.
void expect_none(const Source& s, const std::vector<std::string>& forbidden) {
    for (const std::string& word : words(s.code)) {
        for (const std::string& f : forbidden) {
            const bool found = f.ends_with("::") ? word.starts_with(f) : word == f || word == "std::" + f;
            EXPECT_FALSE(found) << s.path << ": " << word;
        }
    }
}

TEST(Laws, TheSourcesAreThere) {
    EXPECT_GT(library().size(), 20U);
}

TEST(Laws, IncludesPointOnlyDownwards) {
    // Law 1: what each room may include, beside itself, the public headers, mathematics and the runtime's control.
    const std::map<std::string, std::set<std::string>> may{
        {"engine/math", {}},
        {"engine/runtime", {}},
        {"engine/quadric", {"engine/math"}},
        {"engine/surface", {"engine/math", "engine/quadric", "engine/runtime"}},
        {"engine/mesh", {"engine/math", "engine/runtime"}},
        {"engine/partition", {"engine/math", "engine/runtime", "engine/mesh", "engine/quadric", "engine/surface"}},
        {"engine/exact",
         {"engine/math", "engine/runtime", "engine/mesh", "engine/quadric", "engine/surface", "engine/partition"}},
        {"simplify", {"engine/math", "engine/runtime"}},
        {"engine/io", {"engine/math", "engine/runtime"}},
        {"engine/flow",
         {"engine/math", "engine/runtime", "engine/mesh", "engine/quadric", "engine/surface", "engine/partition",
          "engine/exact", "engine/io", "simplify"}},
        {"engine/include", {}},
        {"engine/capi", {}},
    };
    for (const Source& s : library()) {
        const auto allowed = may.find(s.room);
        ASSERT_NE(allowed, may.end()) << s.path << ": a room without a rule";
        for (const std::string& include : s.includes) {
            const std::string room = room_of_include(include);
            if (room.empty() || room == s.room) continue;
            EXPECT_TRUE(allowed->second.contains(room)) << s.path << " includes " << include;
        }
    }
}

TEST(Laws, ToolsSeeTheEngineThroughItsPublicHeaders) {
    // Beside them the program may limit its threads, measure itself and use vectors: headers without any state.
    const std::set<std::string> shared{"\"runtime/parallel.h\"", "\"runtime/resources.h\"", "\"math/vec3.h\""};
    const auto sources = read_sources("tools/cli");
    EXPECT_FALSE(sources.empty());
    for (const Source& s : sources) {
        for (const std::string& include : s.includes) {
            const std::string room = room_of_include(include);
            if (!room.starts_with("engine/") || room == "engine/cli" || shared.contains(include)) continue;
            ADD_FAILURE() << s.path << " includes " << include;
        }
    }
}

TEST(Laws, OnlyTheRuntimeNamesTbb) {
    for (const Source& s : library()) {
        if (s.room == "engine/runtime") continue;
        expect_none(s, {"tbb", "tbb::", "oneapi::", "std::execution::"});
        for (const std::string& include : s.includes) EXPECT_FALSE(include.starts_with("<tbb/")) << s.path;
    }
}

TEST(Laws, TheLibraryPrintsNothingAndNeverExits) {
    for (const Source& s : library()) {
        expect_none(s, {"exit(", "_Exit(", "_exit(", "quick_exit(", "abort(", "terminate(", "assert("});
        expect_none(s, {"printf(", "fprintf(", "puts(", "fputs(", "putchar(", "perror(", "cout", "cerr", "clog",
                        "stderr", "stdout"});
    }
}

TEST(Laws, NoThreadsOfItsOwnAndNoChanceFromOutside) {
    for (const Source& s : library()) {
        expect_none(s, {"std::thread", "std::jthread", "std::async", "pthread_create"});
        expect_none(s, {"random_device", "shuffle", "shuffle(", "uniform_int_distribution", "uniform_real_distribution",
                        "normal_distribution", "rand(", "srand("});
    }
}

TEST(Laws, AForbiddenWordIsFound) {
    // The test of the test: comments and literals do not count, code does.
    const std::string code = code_only("// exit(1)\nconst char* s = \"abort()\"; std::exit (2); 1'000; tbb::task t;");
    const auto found = words(code);
    EXPECT_TRUE(found.contains("std::exit("));
    EXPECT_TRUE(found.contains("tbb::task"));
    EXPECT_FALSE(found.contains("abort("));
    EXPECT_FALSE(found.contains("exit("));
}

TEST(Laws, PublicHeadersIncludeTheStandardLibraryOnly) {
    const auto headers = read_sources("engine/include");
    EXPECT_GE(headers.size(), 7U);
    for (const Source& s : headers) {
        for (const std::string& include : s.includes) {
            const bool own = include.starts_with("<quadseg/");
            const bool standard =
                include[0] == '<' && include.find('/') == std::string::npos &&
                (include.find('.') == std::string::npos || include == "<stddef.h>" || include == "<stdint.h>");
            // Adapters for other libraries' meshes are header-only and included by those who have these libraries.
            if (s.path.find("/adapters/") != std::string::npos) continue;
            EXPECT_TRUE(own || standard) << s.path << " includes " << include;
        }
    }
}

TEST(Laws, FilesAreShort) {
    for (const Source& s : library()) {
        EXPECT_LE(std::count(s.code.begin(), s.code.end(), '\n'), 600) << s.path;
    }
}

}  // namespace
