#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include "names.h"
#include "table_text.h"

namespace pellucid::bench {

namespace {

constexpr const char* kSummarySize = "1920x1080";
constexpr const char* kSummaryTruth = "head_ior1.4";  // a frame with path-traced truth

template <class Value>
void addNew(std::vector<Value>& values, const Value& value) {
  if (std::find(values.begin(), values.end(), value) == values.end()) values.push_back(value);
}

// Rows of the section frames, by what they measure, in the run's order.
class Frames {
public:
  explicit Frames(const Json& results) : results_(results) {
    for (const Json& r : results.at("results")) {
      if (r.at("section") != "frames") continue;
      const Key key{r.at("frame"), r.at("size"), r.at("kind"), r.at("name"), r.value("of", "")};
      rows_[key] = &r;
      addNew(frames_, key.frame);
      addNew(sizes_, key.size);
      if (key.kind != "frame") addNew(names_[key.kind + key.of], key.name);
    }
    if (rows_.empty()) throw InputError("", "results", "no section \"frames\"");
  }

  const std::vector<std::string>& frames() const { return frames_; }
  const std::vector<std::string>& sizes() const { return sizes_; }
  std::vector<std::string> names(const std::string& kind, const std::string& of = "") const {
    const auto found = names_.find(kind + of);
    return found == names_.end() ? std::vector<std::string>() : found->second;
  }
  const Json* find(const std::string& frame, const std::string& size, const std::string& kind,
                   const std::string& name, const std::string& of = "") const {
    const auto row = rows_.find({frame, size, kind, name, of});
    return row == rows_.end() ? nullptr : row->second;
  }
  // "portrait (.139)", by the first size.
  std::string covered(const std::string& frame) const {
    for (const std::string& size : sizes_)
      if (const Json* row = find(frame, size, "frame", "frame"))
        return format("%s (%.3f)", frame.c_str(), row->at("covered").get<double>());
    return frame;
  }
  std::string heading(const std::string& what) const { return runOf(results_) + "; " + what + ":\n\n"; }

private:
  struct Key {
    std::string frame, size, kind, name, of;
    auto operator<=>(const Key&) const = default;
  };
  const Json& results_;
  std::map<Key, const Json*> rows_;
  std::vector<std::string> frames_, sizes_;
  std::map<std::string, std::vector<std::string>> names_;
};

std::string timeOf(const Json& row) { return format("%.0f", row.at("us").get<double>()); }

// Path-traced truth says the error where there is some, else brute force of the diffusion.
std::optional<double> errorOf(const Json& row) {
  for (const char* field : {"truth_relative_rmse", "relative_rmse"})
    if (row.contains(field)) return row[field].get<double>();
  return std::nullopt;
}

std::string header(const std::string& first, const std::vector<std::string>& columns) {
  std::string text = "| " + first + " |", rule = "|-|";
  for (const std::string& column : columns) {
    text += " " + column + " |";
    rule += "-|";
  }
  return text + "\n" + rule + "\n";
}

const Json& whole(const Frames& all, const std::string& frame, const std::string& size,
                  const std::string& name) {
  if (const Json* row = all.find(frame, size, "whole", name)) return *row;
  throw InputError("", "results", "no \"" + name + "\" of frame \"" + frame + "\" at " + size);
}

// The README's tables of two runs: one with times, one with errors against path tracing; either run may have
// both.
class Summary {
public:
  explicit Summary(const std::vector<Json>& runs);
  std::string heading() const;
  // Cells of a whole frame's row. memory: of transients at the times' size.
  std::string time(const std::string& frame, const std::string& name) const;
  std::string error(const std::string& name) const;
  std::string memory(const std::string& name) const;

private:
  const Json* times_ = nullptr;
  const Json* errors_ = nullptr;
};

std::vector<std::string> coveredOf(const Frames& all) {
  std::vector<std::string> columns;
  for (const std::string& frame : all.frames()) columns.push_back(all.covered(frame));
  return columns;
}

// One row a name, one column a frame; a cell has the times of the sizes, and then the error of the first.
std::string byFrame(const Frames& all, const std::string& kind, const std::vector<std::string>& sizes) {
  std::string table = header("", coveredOf(all));
  for (const std::string& name : all.names(kind)) {
    table += "| " + name + " |";
    for (const std::string& frame : all.frames()) {
      std::string times;
      std::optional<double> error;
      for (const std::string& size : sizes) {
        const Json* row = all.find(frame, size, kind, name);
        if (!row) continue;
        if (!times.empty()) times += " / ";
        times += timeOf(*row);
        if (!error) error = errorOf(*row);
      }
      if (error) times += format(", %.2g", *error);
      table += " " + times + " |";
    }
    table += "\n";
  }
  return table;
}

std::string listed(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " / ") + word;
  return text;
}

Summary::Summary(const std::vector<Json>& runs) {
  for (const Json& run : runs)
    for (const Json& r : run.at("results")) {
      if (!times_ && r.value("size", "") == kSummarySize && r.contains("us")) times_ = &run;
      if (!errors_ && r.value("frame", "") == kSummaryTruth && r.contains("truth_relative_rmse_rgb"))
        errors_ = &run;
    }
  if (!times_) throw InputError("", "results", std::string("no times at ") + kSummarySize);
  if (!errors_)
    throw InputError("", "results", std::string("no frame \"") + kSummaryTruth + "\" with path-traced truth");
}

std::string Summary::heading() const {
  return format("Times at %s: %s. Errors of %s: ", kSummarySize, runOf(*times_).c_str(), kSummaryTruth) +
         (times_->at("device") == errors_->at("device")
              ? format("commit `%s`", errors_->at("commit").get<std::string>().c_str())
              : runOf(*errors_)) +
         ".\n\n";
}

std::string Summary::time(const std::string& frame, const std::string& name) const {
  return format(" %s |", timeOf(whole(Frames(*times_), frame, kSummarySize, name)).c_str());
}

std::string Summary::error(const std::string& name) const {
  const Frames all(*errors_);
  const Json& row = whole(all, kSummaryTruth, all.sizes().front(), name);
  return format(" %.3f | %.3f |", row.at("truth_relative_rmse_rgb").at(0).get<double>(),
                row.at("flip").get<double>());
}

std::string Summary::memory(const std::string& name) const {
  const Json& row = whole(Frames(*times_), "portrait", kSummarySize, name);
  return format(" %.0f |", row.at("transient_bytes").get<double>() / 1e6);
}

}  // namespace

std::string framesTable(const Json& results) {
  const Frames all(results);
  std::vector<std::string> sizes;
  for (const std::string& size : all.sizes())
    if (size == "1920x1080" || size == "3840x2160") sizes.push_back(size);
  if (sizes.empty()) sizes = all.sizes();
  return all.heading("microseconds at " + listed(sizes) + ", then the error; in brackets: the covered part") +
         byFrame(all, "whole", sizes);
}

std::string frameHostTable(const Json& results) {
  const Frames all(results);
  const std::string& frame = all.frames().front();
  const std::string& size = all.sizes().back();
  std::string text = runOf(results) + "; " + frame + " at " + size + ", CPU times in microseconds:\n\n" +
                     header("", {"dispatches", "barriers", "transients, MB", "plan", "constants", "record"});
  for (const std::string& name : all.names("whole")) {
    const Json* row = all.find(frame, size, "whole", name);
    if (!row) continue;
    text += format("| %s | %d | %d | %.1f |", name.c_str(), row->at("dispatches").get<int>(),
                   row->at("barriers").get<int>(), row->at("transient_bytes").get<double>() / 1e6);
    for (const char* field : {"cpu_plan_us", "cpu_constants_us", "cpu_record_us"})
      text += row->contains(field) ? format(" %.1f |", row->at(field).get<double>()) : " |";
    text += "\n";
  }
  return text;
}

// A JSON null is NaN: no block of a frame shows the measure.
std::string rgbCell(const Json& row, const char* field) {
  const Json& rgb = row.at(field);
  const auto value = [&](size_t c) { return rgb.at(c).is_null() ? NAN : rgb.at(c).get<double>(); };
  return format(" %.3f %.3f %.3f |", value(0), value(1), value(2));
}

std::string truthTable(const Json& results) {
  const Frames all(results);
  std::string rows;
  for (const std::string& frame : all.frames())
    for (const std::string& size : all.sizes())
      for (const std::string& name : all.names("whole")) {
        const Json* row = all.find(frame, size, "whole", name);
        if (!row || !row->contains("truth_relative_rmse_rgb")) continue;
        const Json& redGreen = row->at("tint_red_green");
        rows += "| " + frame + " " + size + " | " + name + " |" + rgbCell(*row, "truth_relative_rmse_rgb") +
                format(" %d |", row->at("isolated").get<int>()) + rgbCell(*row, "tint") +
                format(" %.3f | %.3f | %.3f |\n", redGreen.is_null() ? NAN : redGreen.get<double>(),
                       row->at("flip").get<double>(), row->at("flip_p99").get<double>());
      }
  if (rows.empty()) throw InputError("", "results", "no frame with path-traced truth");
  return all.heading("relative RMSE of 4x4 averages (R G B), isolated pixels, tint, FLIP") +
         header("frame", {"whole frame", "relative RMSE", "isolated", "tint", "red/green", "FLIP mean",
                          "99th percentile"}) +
         rows;
}

std::string engineTable(const Json& results) {
  const Frames all(results);
  std::string rows;
  for (const std::string& frame : all.frames())
    for (const std::string& size : all.sizes())
      for (const std::string& name : all.names("whole")) {
        const Json* row = all.find(frame, size, "whole", name);
        if (!row || !row->contains("truth_relative_rmse_rgb") || !row->contains("flicker_rgb")) continue;
        rows += "| " + frame + " " + size + " | " + name + " |" + rgbCell(*row, "truth_relative_rmse_rgb") +
                format(" %.3f | %d |", row->at("flip").get<double>(), row->at("spots").get<int>()) +
                rgbCell(*row, "flicker_rgb") + rgbCell(*row, "flicker_irradiance_rgb") +
                format(" %d, %d |\n", row->at("spots_appear").get<int>(), row->at("spots_vanish").get<int>());
      }
  if (rows.empty()) throw InputError("", "results", "no frame with path-traced truth and turned lights");
  return results.at("device").get<std::string>() + ", commit `" + results.at("commit").get<std::string>() +
         "`:\n\n" +
         header("frame", {"whole frame", "relative RMSE", "FLIP mean", "spots", "flicker",
                          "of the irradiance", "spots appear, vanish"}) +
         rows;
}

std::string headlineTable(const std::vector<Json>& runs) {
  const Summary summary(runs);
  std::string table =
      summary.heading() + header("whole frame", {"head, us", "face that fills the screen, us",
                                                 "nothing on screen, us", "error in red", "mean FLIP"});
  for (const std::string& name :
       {kModule, std::string("Jimenez 2010 + 2015, 11 taps"), std::string("HDRP, 20 samples")})
    table += "| " + name + " |" + summary.time("portrait", name) + summary.time("closeup", name) +
             summary.time("nothing", name) + summary.error(name) + "\n";
  return table;
}

std::string samplesTable(const std::vector<Json>& runs) {
  const Summary summary(runs);
  std::string table = summary.heading() +
                      header("`gatherSamples`", {"head, us", "error in red", "mean FLIP", "transients, MB"});
  for (const std::uint32_t samples : kSamples) {
    const std::string name = nameOf(samples);
    table += "| " + std::to_string(samples) + " |" + summary.time("portrait", name) + summary.error(name) +
             summary.memory(name) + "\n";
  }
  return table;
}

std::string contextTable(const Json& results) {
  std::string rows;
  for (const Json& r : results.at("results"))
    if (r.at("section") == "context creation" && r.contains("us"))
      rows += format("| %s | %.2f | %.2f |\n", r.at("name").get<std::string>().c_str(),
                     r["us"].get<double>() / 1e6, r.at("cpu_us").get<double>() / 1e6);
  if (rows.empty()) throw InputError("", "results", "no times in section \"context creation\"");
  return runOf(results) + "; seconds:\n\n" + header("", {"wall clock", "CPU, all threads"}) + rows;
}

}  // namespace pellucid::bench
