// The documents against the project: links, anchors, commands, versions, and the length of the README.
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "options.h"
#include "pellucid/pellucid.h"

namespace {

namespace fs = std::filesystem;

const fs::path kRoot = PELLUCID_SOURCE_DIR;

std::string contents(const fs::path& file) {
  std::ifstream in(file);
  EXPECT_TRUE(in) << file;
  return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<fs::path> filesOf(const std::vector<const char*>& folders,
                              const std::set<std::string>& extensions) {
  std::vector<fs::path> found;
  for (const char* folder : folders)
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / folder))
      if (entry.is_regular_file() && extensions.count(entry.path().extension().string()))
        found.push_back(entry.path());
  return found;
}

// Without what a build or a run may have left in the project's folder.
std::vector<fs::path> documents() {
  std::vector<fs::path> found = filesOf({"docs", "bench", "packaging", ".github"}, {".md"});
  for (const auto& entry : fs::directory_iterator(kRoot))
    if (entry.path().extension() == ".md") found.push_back(entry.path());
  EXPECT_GT(found.size(), 10u) << "the test looks in the wrong place";
  return found;
}

std::string nameOf(const fs::path& file) { return fs::relative(file, kRoot).generic_string(); }

std::vector<std::string> lines(const std::string& text) {
  std::vector<std::string> found;
  std::stringstream stream(text);
  for (std::string line; std::getline(stream, line);) found.push_back(line);
  return found;
}

// ---- Links -----------------------------------------------------------------------------------------

// Anchor of a heading, as GitHub makes it of ASCII.
std::string anchorOf(const std::string& heading) {
  static const std::regex link(R"(\[([^\]]*)\]\([^)]*\))");
  std::string anchor;
  for (const char c : std::regex_replace(heading, link, "$1"))
    if (std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-')
      anchor += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    else if (c == ' ')
      anchor += '-';
  return anchor;
}

std::set<std::string> anchorsOf(const std::string& markdown) {
  std::set<std::string> anchors;
  bool code = false;
  for (const std::string& line : lines(markdown)) {
    if (line.starts_with("```")) code = !code;
    const size_t text = line.find_first_not_of('#');
    if (code || text == 0 || text == std::string::npos || line[text] != ' ') continue;
    const std::string anchor = anchorOf(line.substr(text + 1));
    std::string unique = anchor;
    for (int i = 1; !anchors.insert(unique).second; ++i) unique = anchor + "-" + std::to_string(i);
  }
  return anchors;
}

TEST(Documents, LinksLeadSomewhere) {
  static const std::regex link(R"(\]\(([^)\s]+)\))");
  int checked = 0;
  for (const fs::path& file : documents()) {
    const std::string text = contents(file);
    for (std::sregex_iterator match(text.begin(), text.end(), link), end; match != end; ++match) {
      const std::string target = (*match)[1];
      if (target.find("://") != std::string::npos) continue;
      ++checked;
      const size_t hash = target.find('#');
      const fs::path to = hash == 0 ? file : file.parent_path() / target.substr(0, hash);
      if (!fs::exists(to)) {
        ADD_FAILURE() << nameOf(file) << ": nothing is at " << target;
      } else if (hash != std::string::npos) {
        EXPECT_TRUE(anchorsOf(contents(to)).count(target.substr(hash + 1)))
            << nameOf(file) << ": no heading has the anchor of " << target;
      }
    }
  }
  EXPECT_GT(checked, 60);
}

TEST(Documents, SourcesNameDocumentsThatExist) {
  static const std::regex name(R"(\b(docs/[\w/.-]+\.md))");
  int checked = 0;
  for (const fs::path& file : filesOf({"module", "compute", "gbuffer_harness", "bench", "tests", "tools"},
                                      {".h", ".cpp", ".glsl", ".comp", ".py", ".sh", ".txt"})) {
    const std::string text = contents(file);
    for (std::sregex_iterator match(text.begin(), text.end(), name), end; match != end; ++match, ++checked)
      EXPECT_TRUE(fs::exists(kRoot / (*match)[1].str())) << nameOf(file) << " names " << (*match)[1];
  }
  EXPECT_GT(checked, 20);
}

// ---- Commands --------------------------------------------------------------------------------------

// A shell's words, as far as the documents need them: quotes, and comments and redirections, which end the
// command.
std::vector<std::string> words(const std::string& command) {
  std::vector<std::string> found;
  std::string word;
  char quote = 0;
  bool inWord = false;
  for (const char c : command + " ") {
    if (quote) {
      if (c == quote)
        quote = 0;
      else
        word += c;
    } else if (c == '\'' || c == '"') {
      quote = c;
      inWord = true;
    } else if (c == ' ') {
      if (inWord && word != "...") found.push_back(word);  // "..." stands for options of the line before
      word.clear();
      inWord = false;
    } else if (!inWord && (c == '#' || c == '>' || c == '|')) {
      break;
    } else {
      word += c;
      inWord = true;
    }
  }
  return found;
}

struct Command {
  std::string where;  // file and line
  std::vector<std::string> words;
};

// Lines of code blocks, fenced or indented, that run the program of this name.
std::vector<Command> commandsOf(const std::string& program) {
  std::vector<Command> found;
  for (const fs::path& file : documents()) {
    const std::vector<std::string> text = lines(contents(file));
    bool fenced = false;
    for (size_t i = 0; i < text.size(); ++i) {
      if (text[i].starts_with("```")) fenced = !fenced;
      if (!fenced && !text[i].starts_with("    ")) continue;
      const std::string where = nameOf(file) + ":" + std::to_string(i + 1);
      std::string line = text[i];
      while (line.ends_with("\\") && i + 1 < text.size()) line = line.substr(0, line.size() - 1) + text[++i];
      Command command{where, words(line)};
      if (command.words.empty()) continue;
      const std::string& first = command.words[0];
      if (first == program || first == "build/bin/" + program) found.push_back(std::move(command));
    }
  }
  return found;
}

struct Parsed {};

// The sentence of an error; empty for a command line that is understood. The command does not run.
std::string parse(const Command& command) {
  CLI::App app("", "pellucid");
  app.require_subcommand(1);
  pellucid::harness::addCommands(app);
  // Comes after the checks, and before what the command does.
  app.parse_complete_callback([] { throw Parsed(); });
  try {
    app.parse(std::vector<std::string>(command.words.rbegin(), command.words.rend() - 1));
  } catch (const Parsed&) {
    return "";
  } catch (const CLI::ParseError& e) {
    return e.what();
  }
  return "ran";
}

TEST(Documents, CommandsParse) {
  const std::vector<Command> commands = commandsOf("pellucid");
  EXPECT_GT(commands.size(), 20u);
  for (const Command& command : commands) EXPECT_EQ(parse(command), "") << command.where;
  EXPECT_NE(parse({"", {"pellucid", "replay"}}), "");
  EXPECT_NE(parse({"", {"pellucid", "replay", "a.exr", "--nothing"}}), "");
}

TEST(Documents, CommandsOfTheBenchParse) {
  const std::vector<Command> commands = commandsOf("pellucid_bench");
  for (Command command : commands) {
    std::vector<char*> arguments;
    for (std::string& word : command.words) arguments.push_back(word.data());
    pellucid::bench::Options options;
    EXPECT_EQ(pellucid::bench::readOptions(static_cast<int>(arguments.size()), arguments.data(), options), -1)
        << command.where;
  }
}

// Words of running text such as `pellucid replay --png`: the command and its options exist.
TEST(Documents, OptionsInTheTextExist) {
  static const std::regex span(R"(`(?:build/bin/)?pellucid ([a-z-]+)([^`]*)`)"),
      option(R"((?:^|\s)(--[a-z-]+))");
  CLI::App app("", "pellucid");
  pellucid::harness::addCommands(app);
  int checked = 0;
  for (const fs::path& file : documents()) {
    const std::string text = contents(file);
    for (std::sregex_iterator match(text.begin(), text.end(), span), end; match != end; ++match) {
      const std::string name = (*match)[1], rest = (*match)[2];
      const std::vector<CLI::App*> found =
          app.get_subcommands([&](const CLI::App* command) { return command->get_name() == name; });
      if (found.empty()) {
        ADD_FAILURE() << nameOf(file) << ": there is no command " << name;
        continue;
      }
      for (std::sregex_iterator o(rest.begin(), rest.end(), option); o != std::sregex_iterator();
           ++o, ++checked)
        EXPECT_NE(found[0]->get_option_no_throw((*o)[1].str()), nullptr)
            << nameOf(file) << ": " << name << " has no option " << (*o)[1];
    }
  }
  EXPECT_GE(checked, 10);
}

TEST(Documents, TasksExist) {
  static const std::regex list(R"(\n  deps \|([a-z_ |]+)\) "\$@")"), task(R"(\./run ([a-z_-]+))");
  const std::string script = contents(kRoot / "run");
  std::smatch match;
  ASSERT_TRUE(std::regex_search(script, match, list)) << "the test does not know ./run any more";
  std::set<std::string> tasks = {"deps", "test", "shader-stats"};
  std::stringstream names(match[1].str());
  for (std::string name; names >> name;)
    if (name != "|") tasks.insert(name);
  EXPECT_GT(tasks.size(), 10u);
  for (const fs::path& file : documents()) {
    const std::string text = contents(file);
    for (std::sregex_iterator used(text.begin(), text.end(), task), end; used != end; ++used)
      EXPECT_TRUE(tasks.count((*used)[1])) << nameOf(file) << ": there is no ./run " << (*used)[1];
  }
}

// What a recording disturbs follows from the commands that it calls.
TEST(Documents, NameEveryCommandThatIsRecorded) {
  const std::string table = contents(kRoot / "module/src/context.h");
  const std::string page = contents(kRoot / "docs/integration.md");
  const std::regex command(R"(X\((vkCmd\w+)\))");
  int found = 0;
  for (std::sregex_iterator match(table.begin(), table.end(), command), end; match != end; ++match, ++found)
    EXPECT_NE(page.find("`" + (*match)[1].str() + "`"), std::string::npos) << (*match)[1];
  EXPECT_GT(found, 3);
}

// ---- README and versions ---------------------------------------------------------------------------

TEST(Documents, VersionsAgree) {
  static const std::regex cmake(R"(project\(pellucid VERSION ([\d.]+))"), newest(R"(\n## ([\d.]+))"),
      header(R"(`PELLUCID_HEADER_VERSION` (\d+))");
  const std::string lists = contents(kRoot / "CMakeLists.txt"), changes = contents(kRoot / "CHANGELOG.md");
  std::smatch match;
  ASSERT_TRUE(std::regex_search(lists, match, cmake));
  EXPECT_EQ(match[1], PELLUCID_VERSION) << "CMakeLists.txt and pellucid.h";
  ASSERT_TRUE(std::regex_search(changes, match, newest));
  EXPECT_EQ(match[1], PELLUCID_VERSION) << "CHANGELOG.md and pellucid.h";
  ASSERT_TRUE(std::regex_search(changes, match, header));
  EXPECT_EQ(match[1], std::to_string(PELLUCID_HEADER_VERSION)) << "CHANGELOG.md and pellucid.h";
}

}  // namespace
