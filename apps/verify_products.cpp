// Golden files of products, of the triple product's tensor and of the clamped cosine's matrix.
#include <fmt/format.h>

#include "apps/verify_kinds.h"
#include "sh/clamped_cosine.h"
#include "sh/product_table.h"
#include "sh/products.h"

namespace zonal {
namespace {

/// A quadratic number of bands fits the tables of counts and rows; tables beyond are not what golden files
/// are for.
constexpr int kMostTableBands = 20;

double norm(const std::vector<double>& v) {
  double sum = 0;
  for (double x : v) sum += x * x;
  return std::sqrt(sum);
}

/// Half the last digit of 1: what one rounding costs.
double rounding(Precision p) {
  return p == Precision::kFloat ? 0x1p-24 : 0x1p-53;
}

void verify_pair(const Golden& c, const std::string& label, Report& report) {
  const std::vector<double> a = c.numbers("a");
  const std::vector<double> b = c.numbers("b", a.size());
  const int bands = c.bands("a", a.size());
  for (const Precision p : kPrecisions) {
    const std::vector<double> a_seen = seen(p, a), b_seen = seen(p, b);
    if (!held(a_seen) || !held(b_seen)) continue;
    const double condition = rounding(p) * norm(a_seen) * norm(b_seen);
    const auto check = [&](const char* key, int bands_out) {
      if (!c.has(key)) return;
      const std::vector<double> truth = c.numbers(key, sh::count(bands_out));
      const auto product = [&](auto zero) {
        using T = decltype(zero);
        std::vector<T> out(sh::count(bands_out));
        sh::product(bands, bands, bands_out, as<T>(a_seen).data(), as<T>(b_seen).data(), out.data());
        return out;
      };
      report.check(p, key, label, truth, product, 2 * condition);
    };
    check("product_truncated", bands);
    check("product_full", 2 * bands - 1);
    if (!c.has("double_product")) continue;
    const auto dot = [&](auto zero) {
      using T = decltype(zero);
      return std::vector{sh::dot(bands, as<T>(a_seen).data(), as<T>(b_seen).data())};
    };
    report.check(p, "double_product", label, {c.number("double_product")}, dot,
                 std::sqrt(static_cast<double>(a.size())) * condition);
  }
}

/// Reads `columns` - 1 whole numbers in [low, high] and a value a row.
struct Rows {
  std::vector<std::vector<int>> indices;
  std::vector<double> values;
};

Rows rows_of(const Golden& file, const char* key, size_t columns, int high) {
  Rows rows;
  const std::vector<double> numbers = file.numbers(key, 0, columns);
  for (size_t start = 0; start < numbers.size(); start += columns) {
    std::vector<int>& row = rows.indices.emplace_back();
    for (size_t i = start; i + 1 < start + columns; ++i) {
      if (numbers[i] != std::floor(numbers[i]) || numbers[i] < 0 || numbers[i] >= high)
        file.fail(key, fmt::format("row {}: found {}, expected a whole number in [0, {}]", start / columns,
                                   numbers[i], high - 1));
      row.push_back(static_cast<int>(numbers[i]));
    }
    rows.values.push_back(numbers[start + columns - 1]);
  }
  return rows;
}

void verify_triple_entries(const Golden& file, Report& report) {
  const Rows rows = rows_of(file, "triple_entries", 4, sh::count(kMostTableBands));
  const auto triples = [&](auto zero) {
    using T = decltype(zero);
    std::vector<T> values;
    for (const std::vector<int>& row : rows.indices) {
      const int largest = std::max({row[0], row[1], row[2]});
      const int bands = static_cast<int>(std::sqrt(largest + 0.5)) + 1;
      std::vector<T> unit[3];
      for (int k = 0; k < 3; ++k) unit[k].assign(sh::count(bands), 0), unit[k][row[k]] = 1;
      values.push_back(sh::triple_product(bands, unit[0].data(), unit[1].data(), unit[2].data()));
    }
    return values;
  };
  for (const Precision p : kPrecisions) report.check(p, "triple_entries", "file", rows.values, triples);
}

void verify_clamped_cosine(const Golden& file, Report& report) {
  const Rows rows = rows_of(file, "clamped_cosine", 4, sh::kMaxBands);
  int bands = 1;
  for (const std::vector<int>& row : rows.indices) {
    bands = std::max({bands, row[0] + 1, row[1] + 1});
    if (row[2] > std::min(row[0], row[1]))
      file.fail("clamped_cosine",
                fmt::format("found m = {} beyond l = {}", row[2], std::min(row[0], row[1])));
  }
  // Through the product itself: with Y_l1^m, for both signs of m and both orders of l.
  std::vector<double> truth;
  for (double value : rows.values) truth.insert(truth.end(), 4, value);
  const auto entries = [&](auto zero) {
    using T = decltype(zero);
    std::vector<T> values;
    for (const std::vector<int>& row : rows.indices) {
      for (const int m : {row[2], -row[2]}) {
        for (const auto& [from, to] : {std::pair(row[0], row[1]), std::pair(row[1], row[0])}) {
          std::vector<T> in(sh::count(bands)), out(sh::count(bands));
          in[sh::index(from, m)] = 1;
          sh::clamped_cosine_product(bands, in.data(), out.data());
          values.push_back(out[sh::index(to, m)]);
        }
      }
    }
    return values;
  };
  for (const Precision p : kPrecisions) report.check(p, "clamped_cosine", "file", truth, entries);
}

/// `key` holds a count for 1, 2, 3, ... bands.
template <class Count>
void verify_counts(const Golden& file, const char* key, Report& report, Count count) {
  if (!file.has(key)) return;
  const std::vector<double> truth = file.numbers(key);
  if (truth.size() > kMostTableBands)
    file.fail(key, fmt::format("found {} counts, expected at most {}", truth.size(), kMostTableBands));
  for (const Precision p : kPrecisions) {
    std::vector<double> counts;
    for (size_t n = 1; n <= truth.size(); ++n) {
      const int bands = static_cast<int>(n);
      counts.push_back(p == Precision::kFloat ? count(bands, float{}) : count(bands, double{}));
    }
    report.compare(p, key, "file", counts, truth);
  }
}

}  // namespace

void verify_products(const Golden& file, Report& report) {
  if (file.has("cases"))
    for (const Golden& c : file.objects("cases")) verify_pair(c, label_of(c, report.cases++), report);
  if (file.has("triple_entries")) verify_triple_entries(file, report);
  if (file.has("clamped_cosine")) verify_clamped_cosine(file, report);
  verify_counts(file, "triple_nonzero_count_by_bands", report, [](int bands, auto zero) {
    return static_cast<double>(sh::ProductTable<decltype(zero)>(bands, bands, bands).nonzeros());
  });
  verify_counts(file, "triple_unique_sorted_count_by_bands", report, [](int bands, auto zero) {
    double sorted = 0;
    sh::ProductTable<decltype(zero)>(bands, bands, bands).for_each([&](int i, int j, int k, auto) {
      sorted += i <= j && j <= k;
    });
    return sorted;
  });
  verify_counts(file, "clamped_cosine_nonzero_count_by_bands", report, [](int bands, auto zero) {
    return static_cast<double>(sh::ClampedCosine<decltype(zero)>(bands).nonzeros());
  });
}

}  // namespace zonal
