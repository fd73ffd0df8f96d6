// How subcommands of `pellucid` declare their options. CLI11 is behind it, in command.cpp alone, because each
// source that includes CLI11 takes many seconds to compile.
#pragma once

#include <cstddef>
#include <functional>
#include <initializer_list>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace pellucid::harness {

// A comparison is over a limit the user set (exit code 1). The sentence names the limit and the value.
class LimitExceeded : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

// An option that was just added; each call returns the option itself.
class CommandOption {
public:
  explicit CommandOption(CLI::Option* option) : option_(option) {}

  const CommandOption& required() const;
  const CommandOption& range(int least, int most) const;
  const CommandOption& range(double least, double most) const;
  const CommandOption& positive() const;  // above 0
  const CommandOption& oneOf(std::initializer_list<const char*> values) const;
  const CommandOption& oneOf(std::initializer_list<int> values) const;
  const CommandOption& separatedBy(char separator) const;  // of a list
  const CommandOption& excludes(const CommandOption& other) const;

private:
  CLI::Option* option_;
};

// An option as the command line has it.
struct GivenOption {
  std::string name, group;
  bool positional;
};

// The value type of an optional, or T itself.
template <class T>
struct ValueIn {
  using type = T;
};
template <class T>
struct ValueIn<std::optional<T>> {
  using type = T;
};
template <class T>
using ValueOf = typename ValueIn<T>::type;

class Command {
public:
  Command(CLI::App& app) : app_(&app) {}  // also of tests, which parse for themselves

  Command subcommand(const char* name, const char* help) const;
  // Adds options below a title of the help.
  Command group(const char* title) const;

  // `to` keeps its value without the option; the help shows it unless it is 0 or empty. Lists take all values
  // that are given. T: std::string, a number, an optional or a vector of a string or number; command.cpp
  // lists these types.
  template <class T>
  CommandOption option(const std::string& name, T& to, const std::string& help = "") const;
  // "--name", or "--name,!--opposite". Flag: bool or std::optional<bool>.
  template <class Flag>
  CommandOption flag(const char* name, Flag& to, const std::string& help) const;
  // One of several words, in any case. T: an enumeration or bool, or an optional one.
  template <class T>
  CommandOption choice(const char* name, T& to, const std::vector<std::pair<const char*, ValueOf<T>>>& words,
                       const std::string& help) const {
    std::vector<std::string> names;
    std::vector<ValueOf<T>> values;
    for (const auto& [word, value] : words) {
      names.emplace_back(word);
      values.push_back(value);
    }
    return this->word(
        name, names, [&to, values](std::size_t index) { to = values[index]; }, help);
  }
  // The same, by index.
  CommandOption word(const char* name, const std::vector<std::string>& words,
                     const std::function<void(std::size_t)>& set, const std::string& help) const;

  void footer(const std::string& text) const;  // of the help
  void describe(const char* option, const std::string& help) const;
  void allowAnything() const;
  // Sets the work of the command, which begins after its options are parsed.
  void run(const std::function<void()>& work) const;

  std::string name() const;
  std::vector<std::string> options() const;  // names
  std::vector<GivenOption> given() const;
  bool isGiven(const std::string& option) const;

private:
  CLI::App* app_;
  std::string group_;
};

// Runs the command line. False: the words were wrong and stderr says how.
bool runCommandLine(int argc, char** argv, const char* help, const char* footer,
                    const std::function<void(const Command&)>& addCommands);

}  // namespace pellucid::harness
