#include "results.h"

#include <cstdio>
#include <string>

#include "common/whole_file.h"

namespace pellucid::bench {

using Json = nlohmann::json;

void writeResults(Json results, const std::string& file) {
  Json rows = std::move(results["results"]);
  results.erase("results");
  // One line a row, so that files of a thousand rows stay readable, and so do their differences.
  std::string text = results.dump(1);
  text.resize(text.rfind('\n'));
  text += ",\n \"results\": [";
  for (size_t i = 0; i < rows.size(); ++i)
    text += std::string(i == 0 ? "\n  " : ",\n  ").append(rows[i].dump());
  text += "\n ]\n}\n";
  if (file == "-")
    std::fputs(text.c_str(), stdout);
  else
    harness::writeWholeText(file, text);
}

}  // namespace pellucid::bench
