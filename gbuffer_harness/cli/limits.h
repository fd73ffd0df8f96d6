// --limit of `pellucid compare`: numbers that decide the exit code.
#pragma once

#include <string>
#include <vector>

namespace pellucid::harness {

// A metric that can have a limit.
struct LimitKind {
  std::string name;
  bool least = false;  // the value must be at least the limit; else its magnitude at most
};

// A number to hold against the limits of its name.
struct Measured {
  std::string name;
  std::string of;  // "R", or empty
  double value;
};

class Limits {
public:
  // `texts`: name=number, number >= 0. Throws UsageError, naming the text, for another name or no number.
  Limits(std::vector<LimitKind> kinds, const std::vector<std::string>& texts);

  bool empty() const { return limits_.empty(); }
  // Sentences for the values that are over a limit, with "; " between; a value that is not a number is over.
  std::string over(const std::vector<Measured>& values) const;

private:
  struct Limit {
    LimitKind kind;
    double value;
  };
  std::vector<Limit> limits_;
};

}  // namespace pellucid::harness
