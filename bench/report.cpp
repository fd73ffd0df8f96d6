#include "report.h"

#include <cmath>

namespace pellucid::bench {

namespace {

// More digits than any device repeats.
double rounded(double value) { return std::round(value * 1000) / 1000; }

}  // namespace

void Report::section(const std::string& title, const std::string& name) {
  section_ = name.empty() ? title : name;
  std::fprintf(table_, "\n%-36s %9s %9s %9s %8s %9s %11s %9s\n", title.c_str(), "us", "10 %", "90 %",
               "x floor", "MB", "dispatches", "error");
}

void Report::add(const Row& row, const Time& time) {
  const std::string dispatches = std::to_string(row.dispatches) + " + " + std::to_string(row.barriers);
  std::fprintf(table_, "  %-34s %9.1f %9.1f %9.1f ", row.name.c_str(), time.median, time.low, time.high);
  if (floor_ > 0)
    std::fprintf(table_, "%8.2f", time.median / floor_);
  else
    std::fprintf(table_, "%8s", "-");
  std::fprintf(table_, " %9.1f %11s ", static_cast<double>(row.transientBytes) / 1e6, dispatches.c_str());
  if (row.error)
    std::fprintf(table_, "%9.2g\n", *row.error);
  else
    std::fprintf(table_, "%9s\n", "-");
  std::fflush(table_);  // a run that is stopped has shown what it measured
  nlohmann::json json = {{"section", section_},          {"name", row.name},
                         {"us", rounded(time.median)},   {"p10_us", rounded(time.low)},
                         {"p90_us", rounded(time.high)}, {"dispatches", row.dispatches},
                         {"barriers", row.barriers},     {"transient_bytes", row.transientBytes}};
  if (floor_ > 0) json["floor_ratio"] = rounded(time.median / floor_);
  if (row.error) json["relative_rmse"] = *row.error;
  if (!row.more.is_null()) json.update(row.more);
  rows_.push_back(std::move(json));
}

void Report::note(const std::string& text) {
  std::fprintf(table_, "%s\n", text.c_str());
  std::fflush(table_);
}

void Report::record(nlohmann::json row) {
  row["section"] = section_;
  rows_.push_back(std::move(row));
}

}  // namespace pellucid::bench
