#include "cli/command.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <type_traits>

#include "common/error.h"

namespace pellucid::harness {
namespace {

template <class T>
bool showsDefault(const T& value) {
  if constexpr (std::is_arithmetic_v<T>)
    return value != T{};
  else if constexpr (requires { value.empty(); })
    return !value.empty();
  else
    return false;
}

}  // namespace

const CommandOption& CommandOption::required() const {
  option_->required();
  return *this;
}
const CommandOption& CommandOption::range(int least, int most) const {
  option_->check(CLI::Range(least, most));
  return *this;
}
const CommandOption& CommandOption::range(double least, double most) const {
  option_->check(CLI::Range(least, most));
  return *this;
}
const CommandOption& CommandOption::positive() const {
  option_->check(CLI::PositiveNumber);
  return *this;
}
const CommandOption& CommandOption::oneOf(std::initializer_list<const char*> values) const {
  option_->check(CLI::IsMember(std::vector<std::string>(values.begin(), values.end())));
  return *this;
}
const CommandOption& CommandOption::oneOf(std::initializer_list<int> values) const {
  option_->check(CLI::IsMember(values));
  return *this;
}
const CommandOption& CommandOption::separatedBy(char separator) const {
  option_->delimiter(separator);
  return *this;
}
const CommandOption& CommandOption::excludes(const CommandOption& other) const {
  option_->excludes(other.option_);
  return *this;
}

Command Command::subcommand(const char* name, const char* help) const {
  return *app_->add_subcommand(name, help);
}

Command Command::group(const char* title) const {
  Command grouped = *this;
  grouped.group_ = title;
  return grouped;
}

template <class T>
CommandOption Command::option(const std::string& name, T& to, const std::string& help) const {
  CLI::Option* const option = app_->add_option(name, to, help);
  if (showsDefault(to)) option->capture_default_str();
  if (!group_.empty()) option->group(group_);
  return CommandOption(option);
}

#define PELLUCID_OPTION(...) \
  template CommandOption Command::option(const std::string&, __VA_ARGS__&, const std::string&) const;
PELLUCID_OPTION(std::string)
PELLUCID_OPTION(int)
PELLUCID_OPTION(unsigned)
PELLUCID_OPTION(std::uint64_t)
PELLUCID_OPTION(float)
PELLUCID_OPTION(double)
PELLUCID_OPTION(std::optional<int>)
PELLUCID_OPTION(std::optional<unsigned>)
PELLUCID_OPTION(std::optional<std::uint64_t>)
PELLUCID_OPTION(std::optional<double>)
PELLUCID_OPTION(std::vector<std::string>)
PELLUCID_OPTION(std::vector<int>)

template <class Flag>
CommandOption Command::flag(const char* name, Flag& to, const std::string& help) const {
  CLI::Option* option;
  if constexpr (std::is_same_v<Flag, bool>)
    option = app_->add_flag(name, to, help);
  else  // CLI11 2.1 sets an absent flag of this type to false
    option = app_->add_flag_function(name, [&to](std::int64_t count) { to = count > 0; }, help);
  if (!group_.empty()) option->group(group_);
  return CommandOption(option);
}
template CommandOption Command::flag(const char*, bool&, const std::string&) const;
template CommandOption Command::flag(const char*, std::optional<bool>&, const std::string&) const;

CommandOption Command::word(const char* name, const std::vector<std::string>& words,
                            const std::function<void(std::size_t)>& set, const std::string& help) const {
  const auto chosen = [words, set](const std::string& text) {
    set(static_cast<std::size_t>(std::find(words.begin(), words.end(), text) - words.begin()));
  };
  CLI::Option* const option = app_->add_option_function<std::string>(name, chosen, help);
  option->transform(CLI::IsMember(words, CLI::ignore_case));
  if (!group_.empty()) option->group(group_);
  return CommandOption(option);
}

void Command::footer(const std::string& text) const { app_->footer(text); }
void Command::describe(const char* option, const std::string& help) const {
  app_->get_option(option)->description(help);
}
void Command::allowAnything() const { app_->allow_extras(); }
void Command::run(const std::function<void()>& work) const { app_->callback(work); }

std::string Command::name() const { return app_->get_name(); }

std::vector<std::string> Command::options() const {
  std::vector<std::string> names;
  for (const CLI::Option* option : app_->get_options()) names.push_back(option->get_name());
  return names;
}

std::vector<GivenOption> Command::given() const {
  std::vector<GivenOption> all;
  for (const CLI::Option* option : app_->get_options())
    if (option->count() > 0)
      all.push_back({option->get_name(), option->get_group(), option->get_positional()});
  return all;
}

bool Command::isGiven(const std::string& option) const { return app_->count(option) > 0; }

bool runCommandLine(int argc, char** argv, const char* help, const char* footer,
                    const std::function<void(const Command&)>& addCommands) {
  CLI::App app(help, "pellucid");
  app.require_subcommand(1);
  app.footer(footer);
  addCommands(app);
  try {
    app.parse(argc, argv);
    return true;
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0;  // of --help, too
  }
}

}  // namespace pellucid::harness
