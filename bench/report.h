// The table that people read and the JSON that programs read, from the same rows.
#pragma once

#include <cstdint>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "measure.h"

namespace pellucid::bench {

class Report {
public:
  explicit Report(std::FILE* table) : table_(table) {}

  // `name`: of the section in the JSON; default: the title.
  void section(const std::string& title, const std::string& name = "");
  // From here on times are also stated as multiples of the floor; 0: not.
  void setFloor(double microseconds) { floor_ = microseconds; }

  struct Row {
    std::string name;
    uint32_t dispatches, barriers;
    std::uint64_t transientBytes;  // of images between dispatches
    std::optional<double> error;   // relative RMSE; what against is in the section's title
    nlohmann::json more = {};      // fields of the JSON
  };
  void add(const Row& row, const Time& time);

  // A line of text for people alone.
  void note(const std::string& text);
  // A row for programs alone.
  void record(nlohmann::json row);

  const nlohmann::json& rows() const { return rows_; }

private:
  std::FILE* table_;
  double floor_ = 0;
  std::string section_;
  nlohmann::json rows_ = nlohmann::json::array();
};

}  // namespace pellucid::bench
