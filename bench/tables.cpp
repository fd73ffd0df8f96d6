// Prints the documentation's tables of measured times from the results of a run, or checks or rewrites them
// in a file:
//   pellucid_bench_tables RESULTS.json[,RESULTS.json...] TABLE [--check | --update FILE]
// The tables headline and samples join two files.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "common/error.h"
#include "common/parse.h"
#include "generated_block.h"
#include "names.h"

namespace {

using namespace pellucid::bench;
using pellucid::harness::InputError;
using Json = nlohmann::json;
using Words = std::vector<std::string>;

constexpr const char* kSummarySize = "1920x1080";
constexpr const char* kSummaryTruth = "head_ior1.4";  // a frame with path-traced truth

template <class... Values>
std::string format(const char* pattern, Values... values) {
  char text[256];
  std::snprintf(text, sizeof text, pattern, values...);
  return text;
}

std::string word(const Json& row, const char* field) { return row.at(field).get<std::string>(); }
// A JSON null is NaN: no block of a frame shows the measure.
double number(const Json& value) { return value.is_null() ? NAN : value.get<double>(); }
double number(const Json& row, const char* field) { return number(row.at(field)); }
int whole(const Json& row, const char* field) { return row.at(field).get<int>(); }

// Device, commit and repeats, for a table's heading.
std::string runOf(const Json& results) {
  return format("%s, commit `%s`, median of %d runs", word(results, "device").c_str(),
                word(results, "commit").c_str(), whole(results, "repeat"));
}

std::string header(const Words& columns) {
  std::string text = "|", rule = "|";
  for (const std::string& column : columns) {
    text += " " + column + " |";
    rule += "-|";
  }
  return text + "\n" + rule + "\n";
}

// Rows of the section "frames".
std::vector<const Json*> frameRows(const Json& results, const std::string& kind) {
  std::vector<const Json*> rows;
  for (const Json& row : results.at("results"))
    if (row.at("section") == "frames" && row.at("kind") == kind) rows.push_back(&row);
  if (rows.empty()) throw InputError("", "results", "no section \"frames\"");
  return rows;
}

const Json* find(const std::vector<const Json*>& rows, const std::string& frame, const std::string& size,
                 const std::string& name) {
  const auto row = std::find_if(rows.begin(), rows.end(), [&](const Json* r) {
    return r->at("frame") == frame && r->at("size") == size && r->at("name") == name;
  });
  return row == rows.end() ? nullptr : *row;
}

// The values of a field, each once, in the run's order.
Words valuesOf(const std::vector<const Json*>& rows, const char* field) {
  Words values;
  for (const Json* row : rows)
    if (std::find(values.begin(), values.end(), word(*row, field)) == values.end())
      values.push_back(word(*row, field));
  return values;
}

// The two sizes that pages show, or all where the run has neither.
Words sizesShown(const std::vector<const Json*>& rows) {
  Words sizes;
  for (const std::string& size : valuesOf(rows, "size"))
    if (size == "1920x1080" || size == "3840x2160") sizes.push_back(size);
  return sizes.empty() ? valuesOf(rows, "size") : sizes;
}

// Whole frames beside their errors: a row a method, a column a frame. A cell has the times of two sizes, and
// then the error of the first.
std::string framesTable(const Json& results) {
  const auto frames = frameRows(results, "frame"), rows = frameRows(results, "whole");
  const Words sizes = sizesShown(rows);
  std::string listed;
  for (const std::string& size : sizes) listed.append(listed.empty() ? "" : " / ").append(size);
  Words columns = {""};
  for (const std::string& frame : valuesOf(frames, "frame")) {
    const auto first =
        std::find_if(frames.begin(), frames.end(), [&](const Json* f) { return f->at("frame") == frame; });
    columns.push_back(format("%s (%.3f)", frame.c_str(), number(**first, "covered")));
  }
  std::string table = runOf(results) + "; times in microseconds at " + listed +
                      ", then the error; in brackets: the part of the image with material:\n\n" + header(columns);
  for (const std::string& name : valuesOf(rows, "name")) {
    table += "| " + name + " |";
    for (const std::string& frame : valuesOf(frames, "frame")) {
      std::string times, error;
      for (const std::string& size : sizes) {
        const Json* row = find(rows, frame, size, name);
        if (!row) continue;
        times += (times.empty() ? "" : " / ") + format("%.0f", number(*row, "us"));
        // Path-traced truth says the error where there is some, else brute force of the diffusion.
        for (const char* field : {"truth_relative_rmse", "relative_rmse"})
          if (error.empty() && row->contains(field)) error = format(", %.2g", number(*row, field));
      }
      table += " " + times + error + " |";
    }
    table += "\n";
  }
  return table;
}

// CPU times, memory and dispatches of the first frame at the last size.
std::string frameHostTable(const Json& results) {
  const auto rows = frameRows(results, "whole");
  const std::string frame = valuesOf(rows, "frame").front(), size = valuesOf(rows, "size").back();
  std::string text = runOf(results) + "; " + frame + " at " + size + ", CPU times in microseconds:\n\n" +
                     header({"", "dispatches", "barriers", "transients, MB", "plan", "constants", "record"});
  for (const Json* row : rows) {
    if (row->at("frame") != frame || row->at("size") != size) continue;
    text += format("| %s | %d | %d | %.1f |", word(*row, "name").c_str(), whole(*row, "dispatches"),
                   whole(*row, "barriers"), number(*row, "transient_bytes") / 1e6);
    for (const char* field : {"cpu_plan_us", "cpu_constants_us", "cpu_record_us"})
      text += row->contains(field) ? format(" %.1f |", number(*row, field)) : " |";
    text += "\n";
  }
  return text;
}

std::string contextTable(const Json& results) {
  std::string rows;
  for (const Json& r : results.at("results"))
    if (r.at("section") == "context creation" && r.contains("us"))
      rows += format("| %s | %.2f | %.2f |\n", word(r, "name").c_str(), number(r, "us") / 1e6,
                     number(r, "cpu_us") / 1e6);
  if (rows.empty()) throw InputError("", "results", "no times in section \"context creation\"");
  return runOf(results) + "; seconds:\n\n" + header({"", "wall clock", "CPU, all threads"}) + rows;
}

// Rows of the section "paths" of a kind.
std::vector<const Json*> pathRows(const Json& results, const char* kind) {
  std::vector<const Json*> rows;
  for (const Json& row : results.at("results"))
    if (row.at("section") == "paths" && row.at("kind") == kind) rows.push_back(&row);
  if (rows.empty()) throw InputError("", "results", std::string("no rows \"") + kind + "\" in section \"paths\"");
  return rows;
}

// A row a change, a column a method: RMSE and 99.9th percentile in red.
std::string pathsTable(const Json& results) {
  const auto rows = pathRows(results, "path");
  Words columns = {"change"};
  for (const std::string& name : valuesOf(rows, "name")) columns.push_back(name);
  std::string table = word(results, "device") + ", commit `" + word(results, "commit") +
                      "`; flicker in red: RMSE, 99.9th percentile:\n\n" + header(columns);
  for (const std::string& change : valuesOf(rows, "change")) {
    table += "| " + change + " |";
    for (std::size_t i = 1; i < columns.size(); ++i) {
      const auto row = std::find_if(rows.begin(), rows.end(), [&](const Json* r) {
        return r->at("change") == change && r->at("name") == columns[i];
      });
      table += row == rows.end() ? " |"
                                 : format(" %.4f, %.2f |", number((*row)->at("flicker_rgb").at(0)),
                                          number((*row)->at("p999_rgb").at(0)));
    }
    table += "\n";
  }
  return table;
}

// A row a frame and size: time with an anchor, and with accumulation too.
std::string accumulationTable(const Json& results) {
  const auto rows = pathRows(results, "accumulation");
  std::string table = runOf(results) + "; microseconds:\n\n" + header({"frame", "anchor", "accumulated", "more"});
  for (const std::string& size : sizesShown(rows))
    for (const std::string& frame : valuesOf(rows, "frame")) {
      double us[2] = {0, 0};
      for (const Json* row : rows)
        if (row->at("size") == size && row->at("frame") == frame) us[row->at("accumulates").get<bool>()] = number(*row, "us");
      if (!(us[0] > 0 && us[1] > 0)) continue;
      table += format("| %s, %s | %.0f | %.0f | %.1f %% |\n", frame.c_str(), size.c_str(), us[0], us[1],
                      100 * (us[1] / us[0] - 1));
    }
  return table;
}

std::string rgbCell(const Json& row, const char* field) {
  const Json& rgb = row.at(field);
  return format(" %.3f %.3f %.3f |", number(rgb.at(0)), number(rgb.at(1)), number(rgb.at(2)));
}

// Whole frames that have path-traced truth and `field`; `cells`: of a row after its error.
template <class Cells>
std::string rowsWithTruth(const Json& results, const char* field, const Cells& cells) {
  std::string rows;
  for (const Json* row : frameRows(results, "whole"))
    if (row->contains("truth_relative_rmse_rgb") && row->contains(field))
      rows += "| " + word(*row, "frame") + " " + word(*row, "size") + " | " + word(*row, "name") + " |" +
              rgbCell(*row, "truth_relative_rmse_rgb") + cells(*row) + "\n";
  if (rows.empty())
    throw InputError("", "results", std::string("no frame with path-traced truth has ") + field);
  return rows;
}

std::string truthTable(const Json& results) {
  return runOf(results) + "; relative RMSE of 4x4 averages (R G B), isolated pixels, tint, FLIP:\n\n" +
         header({"frame", "whole frame", "relative RMSE", "isolated", "tint", "red/green", "FLIP mean",
                 "99th percentile"}) +
         rowsWithTruth(results, "flip", [](const Json& row) {
           return format(" %d |", whole(row, "isolated")) + rgbCell(row, "tint") +
                  format(" %.3f | %.3f | %.3f |", number(row, "tint_red_green"), number(row, "flip"),
                         number(row, "flip_p99"));
         });
}

// Captures as engines make them, with turned lights beside.
std::string engineTable(const Json& results) {
  return word(results, "device") + ", commit `" + word(results, "commit") + "`:\n\n" +
         header({"frame", "whole frame", "relative RMSE", "FLIP mean", "spots", "flicker",
                 "of the irradiance", "spots appear, vanish"}) +
         rowsWithTruth(results, "flicker_rgb", [](const Json& row) {
           return format(" %.3f | %d |", number(row, "flip"), whole(row, "spots")) +
                  rgbCell(row, "flicker_rgb") + rgbCell(row, "flicker_irradiance_rgb") +
                  format(" %d, %d |", whole(row, "spots_appear"), whole(row, "spots_vanish"));
         });
}

// The README's tables of two runs: the first one with times, and the first one with errors against path
// tracing; either run may have both.
class Summary {
public:
  explicit Summary(const std::vector<Json>& runs) {
    for (const Json& run : runs)
      for (const Json& r : run.at("results")) {
        if (!times_ && r.value("size", "") == kSummarySize && r.contains("us")) times_ = &run;
        if (!errors_ && r.value("frame", "") == kSummaryTruth && r.contains("truth_relative_rmse_rgb"))
          errors_ = &run;
      }
    if (!times_) throw InputError("", "results", std::string("no times at ") + kSummarySize);
    if (!errors_)
      throw InputError("", "results",
                       std::string("no frame \"") + kSummaryTruth + "\" with path-traced truth");
  }
  std::string heading() const {
    return format("Times at %s: %s. Errors of %s: ", kSummarySize, runOf(*times_).c_str(), kSummaryTruth) +
           (times_->at("device") == errors_->at("device") ? "commit `" + word(*errors_, "commit") + "`"
                                                          : runOf(*errors_)) +
           ".\n\n";
  }
  std::string time(const std::string& frame, const std::string& name) const {
    return format(" %.0f |", number(row(*times_, frame, kSummarySize, name), "us"));
  }
  std::string error(const std::string& name) const {
    const std::string size = valuesOf(frameRows(*errors_, "frame"), "size").front();
    const Json& r = row(*errors_, kSummaryTruth, size, name);
    return format(" %.3f | %.3f |", number(r.at("truth_relative_rmse_rgb").at(0)), number(r, "flip"));
  }
  std::string memory(const std::string& name) const {
    return format(" %.0f |", number(row(*times_, "portrait", kSummarySize, name), "transient_bytes") / 1e6);
  }

private:
  static const Json& row(const Json& run, const std::string& frame, const std::string& size,
                         const std::string& name) {
    if (const Json* found = find(frameRows(run, "whole"), frame, size, name)) return *found;
    throw InputError("", "results", "no \"" + name + "\" of frame \"" + frame + "\" at " + size);
  }

  const Json* times_ = nullptr;
  const Json* errors_ = nullptr;
};

// Times and errors beside others'.
std::string headlineTable(const std::vector<Json>& runs) {
  const Summary summary(runs);
  std::string table = summary.heading() + header({"whole frame", "head, us", "face that fills the screen, us",
                                                  "nothing on screen, us", "error in red", "mean FLIP"});
  for (const std::string& name : Words{kModule, "Jimenez 2010 + 2015, 11 taps", "HDRP, 20 samples"})
    table += "| " + name + " |" + summary.time("portrait", name) + summary.time("closeup", name) +
             summary.time("nothing", name) + summary.error(name) + "\n";
  return table;
}

// Time, error and memory by samples.
std::string samplesTable(const std::vector<Json>& runs) {
  const Summary summary(runs);
  std::string table = summary.heading() +
                      header({"`gatherSamples`", "head, us", "error in red", "mean FLIP", "transients, MB"});
  for (const std::uint32_t samples : kSamples) {
    const std::string name = nameOf(samples);
    table += "| " + std::to_string(samples) + " |" + summary.time("portrait", name) + summary.error(name) +
             summary.memory(name) + "\n";
  }
  return table;
}

template <std::string (*make)(const Json&)>
std::string ofOne(const std::vector<Json>& runs) {
  return make(runs.front());
}

struct Table {
  const char* name;
  std::string (*make)(const std::vector<Json>& runs);
};

constexpr Table kTables[] = {{"frames", ofOne<framesTable>},   {"frame_host", ofOne<frameHostTable>},
                             {"context", ofOne<contextTable>}, {"truth", ofOne<truthTable>},
                             {"engine", ofOne<engineTable>},   {"headline", headlineTable},
                             {"samples", samplesTable},       {"paths", ofOne<pathsTable>},
                             {"accumulation", ofOne<accumulationTable>}};

}  // namespace

int main(int argc, char** argv) {
  const std::string name = argc > 2 ? argv[2] : "";
  const auto table =
      std::find_if(std::begin(kTables), std::end(kTables), [&](const Table& t) { return t.name == name; });
  if (table == std::end(kTables)) {
    std::string names;
    for (const Table& t : kTables) names.append(names.empty() ? "" : "|").append(t.name);
    std::fprintf(stderr, "usage: pellucid_bench_tables RESULTS.json[,...] %s [--check|--update FILE]\n",
                 names.c_str());
    return 2;
  }
  try {
    std::vector<Json> runs;
    for (const std::string& path : pellucid::harness::split(argv[1], ',')) {
      std::ifstream file(path);
      runs.push_back(Json::parse(file));
    }
    return generatedBlock(argc - 3, argv + 3, name, table->make(runs));
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s: %s\n", argv[1], e.what());
    return 1;
  }
}
