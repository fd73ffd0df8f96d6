// A JSON value that knows where it stands, so that every complaint names the file, the path and the value.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace pellucid::harness {

// Parses JSON text. Throws InputError for syntax errors, for a key that stands twice in one object, and for more than 100 levels.
nlohmann::json parseJson(const std::string& file, const std::string& text);
// Parses a JSON file. Throws InputError as parseJson() does, and for a file that cannot be read.
nlohmann::json readJson(const std::filesystem::path& path);

class Field {
public:
  Field(const std::string& file, const nlohmann::json& value) : Field(file, "", value) {}

  const std::string& path() const { return path_; }  // "lights[2].color"; empty: the root
  const std::string& file() const { return file_; }

  const nlohmann::json& value() const { return *value_; }

  // Throws InputError: file, path, then `sentence`.
  [[noreturn]] void fail(const std::string& sentence) const;
  // The value as a message shows it: JSON, shortened.
  std::string shown() const;

  // An object with no key but these.
  void allowKeys(std::initializer_list<std::string_view> keys) const;
  bool has(const char* key) const { return value_->is_object() && value_->contains(key); }
  std::optional<Field> find(const char* key) const;
  Field operator[](const char* key) const;                     // throws when missing
  std::vector<std::pair<std::string, Field>> members() const;  // but for comments, keys that begin with //
  std::vector<Field> items() const;

  // A number that a float can hold: finite, at most 3.4e38.
  double number() const;
  double number(double least, double most) const;  // a value that lies a rounding outside becomes the bound
  int integer(int least, int most) const;
  bool boolean() const;
  std::string text() const;  // not empty
  // Index of the string among `choices`.
  std::size_t choice(std::initializer_list<std::string_view> choices) const;
  std::size_t choice(std::span<const std::string> choices) const;
  std::vector<double> numbers() const;  // array of any length >= 1
  std::vector<double> numbers(double least, double most) const;
  template <std::size_t N>
  std::array<double, N> numbers() const {
    return counted<N>(numbers());
  }
  template <std::size_t N>
  std::array<double, N> numbers(double least, double most) const {
    return counted<N>(numbers(least, most));
  }

private:
  template <std::size_t N>
  std::array<double, N> counted(const std::vector<double>& values) const {
    if (values.size() != N) failCount(N);
    std::array<double, N> result;
    for (std::size_t i = 0; i < N; ++i) result[i] = values[i];
    return result;
  }

  Field(const std::string& file, std::string path, const nlohmann::json& value)
      : file_(file), path_(std::move(path)), value_(&value) {}
  [[noreturn]] void failCount(std::size_t expected) const;
  Field member(const std::string& key, const nlohmann::json& value) const;

  std::string file_;
  std::string path_;
  const nlohmann::json* value_;  // the caller keeps the document
};

}  // namespace pellucid::harness
