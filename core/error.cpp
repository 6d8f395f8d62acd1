#include "core/error.h"

#include <algorithm>
#include <cctype>
#include <numeric>
#include <vector>

namespace zonal {
namespace {

/// Names longer than this were not typed by hand; comparing them would only cost time.
constexpr size_t kLongestName = 64;
/// As many as fit an error line that is still read.
constexpr size_t kListed = 24;

char lower(char c) {
  return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
}

/// Insertions, deletions, substitutions and swaps of neighbours that turn a into b, case ignored (the
/// "optimal string alignment" distance of Damerau and Levenshtein, three rows of its table at a time).
size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<size_t> two_above(b.size() + 1), above(b.size() + 1), row(b.size() + 1);
  std::iota(above.begin(), above.end(), size_t(0));
  for (size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      const bool same = lower(a[i - 1]) == lower(b[j - 1]);
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + (same ? 0 : 1)});
      const bool swapped =
          i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) && lower(a[i - 2]) == lower(b[j - 1]);
      if (swapped) row[j] = std::min(row[j], two_above[j - 2] + 1);
    }
    two_above.swap(above);
    above.swap(row);
  }
  return above[b.size()];
}

/// "pos" means "position": what somebody writes who does not remember the end.
bool abbreviates(std::string_view name, std::string_view candidate) {
  if (name.size() < 3 || name.size() > candidate.size()) return false;
  return std::equal(name.begin(), name.end(), candidate.begin(),
                    [](char x, char y) { return lower(x) == lower(y); });
}

}  // namespace

std::string nearest_name(std::string_view name, std::span<const std::string> candidates) {
  if (name.empty() || name.size() > kLongestName) return "";
  std::string best, longer;
  size_t best_distance = kLongestName;
  for (const std::string& candidate : candidates) {
    if (candidate.empty() || candidate.size() > kLongestName) continue;
    if (longer.empty() && abbreviates(name, candidate)) longer = candidate;

    // One slip in three letters is a typo; more, or every letter, is another word.
    const size_t distance = edit_distance(name, candidate);
    const size_t allowed = std::max<size_t>(1, std::max(name.size(), candidate.size()) / 3);
    const bool near_enough = distance <= allowed && distance < std::min(name.size(), candidate.size());
    if (near_enough && distance < best_distance) best = candidate, best_distance = distance;
  }
  return best.empty() ? longer : best;
}

std::string did_you_mean(std::string_view name, std::span<const std::string> candidates) {
  if (candidates.empty()) return "";
  const std::string nearest = nearest_name(name, candidates);
  if (!nearest.empty()) return " (did you mean \"" + nearest + "\"?)";

  std::string list = " (there is: ";
  for (size_t i = 0; i < std::min(candidates.size(), kListed); ++i) {
    if (i > 0) list += ", ";
    list +=
        candidates[i].size() <= kLongestName ? candidates[i] : candidates[i].substr(0, kLongestName) + "...";
  }
  if (candidates.size() > kListed) list += ", and " + std::to_string(candidates.size() - kListed) + " more";
  return list + ")";
}

}  // namespace zonal
