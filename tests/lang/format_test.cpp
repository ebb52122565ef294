// SPDX-License-Identifier: MIT
// The canonical form: stable, the same tree, every comment.
#include "puppetri/lang/format.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include "lang/dump.h"

using namespace puppetri;
using namespace puppetri::lang;

namespace {

std::string read(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    std::stringstream buffer;
    buffer << in.rdbuf();
    return buffer.str();
}

// Whole files that parse: the corpus and the examples.
std::vector<std::string> good_files() {
    std::vector<std::string> out;
    for (const char* folder : {PUP_SOURCE_DIR "/tests/corpus", PUP_SOURCE_DIR "/examples"}) {
        if (!std::filesystem::exists(folder)) {
            continue;
        }
        for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
            if (entry.path().extension() == ".pup") {
                std::string text = read(entry.path());
                if (parse(text, "x").diagnostics.empty()) {
                    out.push_back(std::move(text));
                }
            }
        }
    }
    return out;
}

std::string formatted(const std::string& text) {
    Checked<std::string> result = format(text, "test.pup");
    if (!result) {
        for (const Diagnostic& d : result.error()) {
            FAIL_CHECK(format_diagnostic(d, "", false) << text);
        }
        return {};
    }
    return std::move(result).value();
}

std::vector<std::string> comments_of(const std::string& text) {
    std::vector<std::string> out;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        if (const std::size_t at = line.find("# note"); at != std::string::npos) {
            out.push_back(line.substr(at, line.find_last_not_of(" \t\r") + 1 - at));
        }
    }
    return out;
}

}  // namespace

TEST_CASE("formatting twice is formatting once, and the tree stays [law]") {
    const std::vector<std::string> files = good_files();
    REQUIRE(files.size() >= 2);
    for (const std::string& text : files) {
        const std::string once = formatted(text);
        CHECK(formatted(once) == once);
        CHECK(testing::Dump::of(parse(text, "a").file) == testing::Dump::of(parse(once, "a").file));
        CHECK(once.find(" \n") == std::string::npos);
        CHECK(once.find("\n\n\n") == std::string::npos);
        CHECK(once.back() == '\n');
    }
}

TEST_CASE("the project's own scenes are in canonical form [golden]") {
    // `puppetri fmt FILE --write` brings them there.
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(PUP_SOURCE_DIR "/examples")) {
        if (entry.path().extension() == ".pup") {
            const std::string text = read(entry.path());
            const bool canonical = formatted(text) == text;
            CHECK_MESSAGE(canonical, entry.path().string());
        }
    }
}

TEST_CASE("comments survive wherever they stand [law]") {
    std::mt19937 random(7);
    for (const std::string& text : good_files()) {
        if (text.size() > 20000) {
            continue;
        }
        for (int round = 0; round < 40; ++round) {
            // At the ends of lines, and as lines of their own: everywhere a comment can be put
            // without being inside a text or joining what a backslash joins.
            std::istringstream lines(text);
            std::string with;
            int number = 0;
            for (std::string line; std::getline(lines, line);) {
                const bool free =
                    line.find('#') == std::string::npos && line.find('\\') == std::string::npos;
                if (free && random() % 3 == 0) {
                    with += std::string(random() % 5, ' ') + "# note own " +
                            std::to_string(number++) + "\n";
                }
                with += line;
                if (free && random() % 3 == 0) {
                    with += std::string(random() % 3, ' ') + " # note end " +
                            std::to_string(number++) + std::string(random() % 3, ' ');
                }
                with += std::string(1 + random() % 3 / 2, '\n');
            }
            const std::string once = formatted(with);
            REQUIRE(comments_of(once) == comments_of(with));
            REQUIRE(formatted(once) == once);
            REQUIRE(testing::Dump::of(parse(with, "a").file) ==
                    testing::Dump::of(parse(once, "a").file));
        }
    }
}

TEST_CASE("white space does not matter [law]") {
    std::mt19937 random(11);
    for (const std::string& text : good_files()) {
        // More blanks where there is one, outside of texts, comments and names in quotes.
        std::string wide;
        char quote = 0;
        for (const char c : text) {
            if (c == '\n') {
                quote = 0;
            } else if (quote == 0 && (c == '"' || c == '\'' || c == '#')) {
                quote = c;
            } else if (quote == c && c != '#') {
                quote = 0;
            }
            wide += c;
            if (c == ' ' && quote == 0) {
                wide.append(random() % 4, random() % 2 == 0 ? ' ' : '\t');
            }
        }
        CHECK(formatted(wide) == formatted(text));
    }
}

TEST_CASE("neighbouring statements of one kind are laid out as a table [golden]") {
    CHECK(formatted("net n {\nplace a \"first\" takes 2 s\nplace long_name takes 3 s # "
                    "note\n\n\n\nstop: a->b\n  go_on  : long_name+a "
                    "-> a priority -1\n}") ==
          "net n {\n"
          "  place a         \"first\"  takes 2 s\n"
          "  place long_name          takes 3 s  # note\n"
          "\n"
          "  stop:  a             -> b\n"
          "  go_on: long_name + a -> a  priority -1\n"
          "}\n");
    CHECK(
        formatted("cast {\nana: mannequin {height 1.75 m,at (-1.5,0,0) m}\nball : sphere {}\n}") ==
        "cast {\n"
        "  ana:  mannequin { height 1.75 m, at (-1.5, 0, 0) m }\n"
        "  ball: sphere    { }\n"
        "}\n");
    CHECK(formatted("rule a \"x\" never p\nrule long mutex (p,q)") ==
          "rule a    \"x\"  never p\n"
          "rule long      mutex(p, q)\n");
}

TEST_CASE("a table that is too wide is aligned in its first columns [golden]") {
    const std::string wide(60, 'w'), wider(100, 'w');
    CHECK(formatted("t: " + wider + " -> a\nlong: a -> b" + wide) ==
          "t:    " + wider + " -> a\nlong: a -> b" + wide + "\n");
    CHECK(formatted("t: a -> after 2 s\nu: a -> bb") == "t: a ->  after 2 s\nu: a -> bb\n");
}

TEST_CASE("spacing of expressions has one form [golden]") {
    const auto state = [](const std::string& text) {
        const std::string out = formatted("state s=" + text);
        return out.substr(10, out.size() - 11);
    };
    CHECK(state("a+b * c/ 2") == "a + b*c/2");
    CHECK(state("- a- -b") == "-a - -b");
    CHECK(state("not(a and b)") == "not (a and b)");
    CHECK(state("a?1:0") == "a ? 1 : 0");
    CHECK(state("f( x ,y :[1,2] s)") == "f(x, y: [1, 2] s)");
    CHECK(state("3m/s^2") == "3 m/s^2");
    CHECK(state("3 m / s") == "3 m / s");
    CHECK(state("0..n-1") == "0 .. n - 1");
    CHECK(state("#P>2") == "#P > 2");
    CHECK(state("a . b") == "a.b");
    CHECK(state("f(a?b:c, d:e)") == "f(a ? b : c, d: e)");
}

TEST_CASE("line breaks of the author stay and are indented [golden]") {
    CHECK(formatted("net n {\nt: a +\nb\n-> c when f(x,\ny)\n# own\n}") ==
          "net n {\n"
          "  t: a +\n"
          "      b\n"
          "      -> c when f(x,\n"
          "      y)\n"
          "  # own\n"
          "}\n");
    CHECK(formatted("place a \\\n takes 2 s") == "place a \\\n    takes 2 s\n");
}

TEST_CASE("a file with defects is not formatted [unit]") {
    const Checked<std::string> result = format("place place place", "x.pup");
    REQUIRE_FALSE(result.has_value());
    CHECK(result.error()[0].where.file == "x.pup");
    CHECK(formatted("") == "");
    CHECK(formatted("\n\n# only a comment\n\n") == "# only a comment\n");
}
