#include "capture/json_field.h"

#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <set>

#include "common/bounds.h"
#include "common/error.h"

namespace pellucid::harness {


nlohmann::json parseJson(const std::string& file, const std::string& text) {
  // The library keeps the last of two equal keys; a manifest that says a thing twice is wrong.
  std::vector<std::set<std::string>> open;
  constexpr int kMostLevels = 100;  // what writes a value to text calls itself for each
  const auto refuseTwins = [&](int depth, nlohmann::json::parse_event_t event, nlohmann::json& parsed) {
    if (depth > kMostLevels) throw InputError(file, "", "its JSON is nested deeper than " + std::to_string(kMostLevels) + " levels");
    if (event == nlohmann::json::parse_event_t::object_start) open.emplace_back();
    if (event == nlohmann::json::parse_event_t::object_end) open.pop_back();
    if (event == nlohmann::json::parse_event_t::key && !open.back().insert(parsed.get<std::string>()).second)
      throw InputError(file, parsed.get<std::string>(), "the key stands twice in one object");
    return true;
  };
  try {
    return nlohmann::json::parse(text, refuseTwins);
  } catch (const nlohmann::json::exception& error) {
    throw InputError(file, "", std::string("not valid JSON: ") + error.what());
  }
}

nlohmann::json readJson(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string text(std::istreambuf_iterator<char>(file), {});
  if (!file) throw InputError(path.string(), "", "cannot be read");
  return parseJson(path.string(), text);
}

void Field::fail(const std::string& sentence) const { throw InputError(file_, path_, sentence); }

void Field::failCount(std::size_t expected) const {
  fail("needs " + std::to_string(expected) + " numbers, has " + std::to_string(value_->size()));
}

std::string Field::shown() const {
  constexpr std::size_t kLongest = 60;
  std::string text = value_->dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
  if (text.size() > kLongest) text = text.substr(0, kLongest) + "...";
  return text;
}

void Field::allowKeys(std::initializer_list<std::string_view> keys) const {
  for (const auto& [key, field] : members()) {
    bool known = false;
    std::string list;
    for (const std::string_view candidate : keys) {
      known = known || candidate == key;
      list += (list.empty() ? "" : ", ") + std::string(candidate);
    }
    if (!known) field.fail("unknown key; known here: " + list);
  }
}

Field Field::member(const std::string& key, const nlohmann::json& value) const {
  return Field(file_, path_.empty() ? key : path_ + "." + key, value);
}

std::optional<Field> Field::find(const char* key) const {
  if (!has(key)) return std::nullopt;
  return member(key, value_->at(key));
}

Field Field::operator[](const char* key) const {
  if (!has(key)) throw InputError(file_, path_.empty() ? key : path_ + "." + key, "missing");
  return member(key, value_->at(key));
}

std::vector<std::pair<std::string, Field>> Field::members() const {
  if (!value_->is_object()) fail("must be an object, is " + shown());
  std::vector<std::pair<std::string, Field>> result;
  for (const auto& [key, value] : value_->items())
    if (!key.starts_with("//")) result.emplace_back(key, member(key, value));
  return result;
}

std::vector<Field> Field::items() const {
  if (!value_->is_array()) fail("must be an array, is " + shown());
  std::vector<Field> result;
  for (std::size_t i = 0; i < value_->size(); ++i)
    result.push_back(Field(file_, path_ + "[" + std::to_string(i) + "]", (*value_)[i]));
  return result;
}

double Field::number() const {
  if (!value_->is_number()) fail("must be a number, is " + shown());
  const double result = value_->get<double>();
  if (!(std::abs(result) <= static_cast<double>(std::numeric_limits<float>::max())))
    fail("must be a finite number that a 32-bit float can hold, is " + shown());
  return result;
}

double Field::number(double least, double most) const {
  const double result = fitted(number(), least, most);
  if (result < least) fail("must be at least " + nlohmann::json(least).dump() + ", is " + shown());
  if (result > most) fail("must be at most " + nlohmann::json(most).dump() + ", is " + shown());
  return result;
}

int Field::integer(int least, int most) const {
  const double result = number(least, most);
  if (result != number() || result != std::floor(result)) fail("must be a whole number, is " + shown());
  return static_cast<int>(result);
}

bool Field::boolean() const {
  if (!value_->is_boolean()) fail("must be true or false, is " + shown());
  return value_->get<bool>();
}

std::string Field::text() const {
  if (!value_->is_string()) fail("must be a string, is " + shown());
  std::string result = value_->get<std::string>();
  if (result.empty()) fail("must not be empty");
  return result;
}

std::size_t Field::choice(std::initializer_list<std::string_view> choices) const {
  return choice(std::vector<std::string>(choices.begin(), choices.end()));
}

std::size_t Field::choice(std::span<const std::string> choices) const {
  const std::string value = text();
  std::string list;
  std::size_t index = 0;
  for (const std::string& candidate : choices) {
    if (candidate == value) return index;
    list += (list.empty() ? "\"" : ", \"") + candidate + "\"";
    ++index;
  }
  fail("must be one of " + list + ", is " + shown());
}

std::vector<double> Field::numbers() const {
  constexpr double kMost = std::numeric_limits<float>::max();
  return numbers(-kMost, kMost);
}

std::vector<double> Field::numbers(double least, double most) const {
  std::vector<double> result;
  for (const Field& item : items()) result.push_back(item.number(least, most));
  if (result.empty()) fail("must not be empty");
  return result;
}

}  // namespace pellucid::harness
