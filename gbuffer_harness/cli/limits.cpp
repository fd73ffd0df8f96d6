#include "cli/limits.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "common/error.h"
#include "common/parse.h"

namespace pellucid::harness {

Limits::Limits(std::vector<LimitKind> kinds, const std::vector<std::string>& texts) {
  for (const std::string& text : texts) {
    const std::size_t equals = text.find('=');
    const std::string name = text.substr(0, equals);
    const auto kind =
        std::find_if(kinds.begin(), kinds.end(), [&](const LimitKind& k) { return k.name == name; });
    if (equals == std::string::npos || kind == kinds.end()) {
      std::string known;
      for (const LimitKind& k : kinds) known += (known.empty() ? "" : ", ") + k.name + "=";
      throw UsageError("--limit \"" + text + "\": must be one of " + known + " and a number");
    }
    const std::optional<double> value = numberIn<double>(text.substr(equals + 1));
    if (!value || !(*value >= 0))
      throw UsageError("--limit \"" + text + "\": \"" + text.substr(equals + 1) + "\" is not a number >= 0");
    limits_.push_back({*kind, *value});
  }
}

std::string Limits::over(const std::vector<Measured>& values) const {
  std::ostringstream over;
  for (const Limit& limit : limits_)
    for (const Measured& measured : values) {
      if (measured.name != limit.kind.name) continue;
      const bool allowed =
          limit.kind.least ? measured.value >= limit.value : std::abs(measured.value) <= limit.value;
      if (allowed) continue;
      over << (over.str().empty() ? "" : "; ") << measured.name
           << (measured.of.empty() ? "" : " of " + measured.of) << " is " << measured.value << ", the limit "
           << limit.value;
    }
  return over.str();
}

}  // namespace pellucid::harness
