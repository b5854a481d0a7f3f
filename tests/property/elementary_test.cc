// The elementary functions against MPFR: each is wrong by less than one unit in the last place, over all ranges, and the
// special values are those of annex F of the C standard.
//
// RAYSHADE_ELEMENTARY_ARGUMENTS: how many arguments for each range; `make check-processors` takes a million.
// SPDX-License-Identifier: BSD-3-Clause
#include "rayshade/base/elementary.h"

#include <gtest/gtest.h>
#include <mpfr.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <limits>
#include <numbers>
#include <type_traits>
#include <utility>

#include "tests/support/random.h"

namespace rayshade {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kTiniest = std::numeric_limits<double>::denorm_min();
constexpr double kHugest = std::numeric_limits<double>::max();

class Exact {
 public:
  explicit Exact(mpfr_prec_t bits) { mpfr_init2(number_, bits); }
  Exact(const Exact&) = delete;
  Exact& operator=(const Exact&) = delete;
  ~Exact() { mpfr_clear(number_); }
  mpfr_ptr get() { return number_; }

 private:
  mpfr_t number_;
};

// In units of the last place that the exact number has as a double.
double errorOf(double got, Exact& exact) {
  if (mpfr_nan_p(exact.get()) || std::isnan(got))
    return mpfr_nan_p(exact.get()) && std::isnan(got) ? 0 : kInfinite;
  if (mpfr_inf_p(exact.get())) return got == mpfr_get_d(exact.get(), MPFR_RNDN) ? 0 : kInfinite;
  if (mpfr_zero_p(exact.get())) return got == 0 ? 0 : kInfinite;
  const mpfr_exp_t unit = std::max<mpfr_exp_t>(mpfr_get_exp(exact.get()) - 53, -1074);
  if (unit > 1023 - 52)
    return std::isinf(got) && std::signbit(got) == (mpfr_sgn(exact.get()) < 0) ? 0 : kInfinite;
  Exact difference(100);
  if (std::isinf(got)) {  // as if there were doubles beyond
    mpfr_set_ui_2exp(difference.get(), 1, 1024, MPFR_RNDN);
    if (got < 0) mpfr_neg(difference.get(), difference.get(), MPFR_RNDN);
    mpfr_sub(difference.get(), exact.get(), difference.get(), MPFR_RNDN);
  } else {
    mpfr_sub_d(difference.get(), exact.get(), got, MPFR_RNDN);
  }
  mpfr_mul_2si(difference.get(), difference.get(), -unit, MPFR_RNDN);
  return std::abs(mpfr_get_d(difference.get(), MPFR_RNDN));
}

int argumentsOfARange() {
  const char* wanted = std::getenv("RAYSHADE_ELEMENTARY_ARGUMENTS");
  return wanted ? std::atoi(wanted) : 5000;
}

using Pair = std::pair<double, double>;

// Looks at one function; the destructor says how wrong it was at most.
class Judge {
 public:
  using Reference = std::function<void(mpfr_ptr, mpfr_ptr, mpfr_ptr)>;
  Judge(const char* name, std::function<double(double, double)> function, Reference reference, double limit)
      : name_(name), function_(std::move(function)), reference_(std::move(reference)), limit_(limit) {}
  Judge(const Judge&) = delete;
  Judge& operator=(const Judge&) = delete;
  ~Judge() {
    EXPECT_LT(worst_, limit_) << name_;
    std::printf("%-6s wrong by at most %.4f units, at %a %a\n", name_, worst_, at_.first, at_.second);
  }

  void look(double x, double y = 0) {
    mpfr_set_d(x_.get(), x, MPFR_RNDN);
    mpfr_set_d(y_.get(), y, MPFR_RNDN);
    reference_(exact_.get(), x_.get(), y_.get());
    const double error = errorOf(function_(x, y), exact_);
    if (error > worst_ || std::isnan(error)) worst_ = error, at_ = {x, y};
  }
  template <class Argument>
  void range(const Argument& argument) {
    for (int i = argumentsOfARange(); i > 0; --i) {
      if constexpr (std::is_same_v<decltype(argument()), Pair>) {
        const Pair pair = argument();
        look(pair.first, pair.second);
      } else {
        look(argument());
      }
    }
  }

 private:
  const char* name_;
  std::function<double(double, double)> function_;
  Reference reference_;
  double limit_, worst_ = 0;
  Pair at_;
  Exact x_{53}, y_{53}, exact_{90};
};

// What most of them stay below; the others say why not.
constexpr double kUsual = 0.54;

Judge judge(const char* name, double (*function)(double), int (*reference)(mpfr_ptr, mpfr_srcptr, mpfr_rnd_t),
            double limit = kUsual) {
  return {name, [=](double x, double) { return function(x); },
          [=](mpfr_ptr result, mpfr_ptr x, mpfr_ptr) { reference(result, x, MPFR_RNDN); }, limit};
}
Judge judge(const char* name, double (*function)(double, double),
            int (*reference)(mpfr_ptr, mpfr_srcptr, mpfr_srcptr, mpfr_rnd_t), double limit = kUsual) {
  return {name, function,
          [=](mpfr_ptr result, mpfr_ptr x, mpfr_ptr y) { reference(result, x, y, MPFR_RNDN); }, limit};
}

class Elementary : public ::testing::Test {
 protected:
  // All doubles alike: half of them are huge or tiny, some are not finite.
  double any() { return std::bit_cast<double>(random_.bits()); }
  double subnormal() { return std::bit_cast<double>(random_.bits() & 0x800fffffffffffff); }
  double real(double low, double high) { return random_.real(low, high); }
  double signedMagnitude(double least, double most) {
    return (random_.oneIn(2) ? 1 : -1) * random_.magnitude(least, most);
  }
  Pair close() {  // of sizes that are not too different, anywhere
    const double x = any();
    return {x, x * signedMagnitude(1e-18, 1e18)};
  }

  void angles(Judge& judge) {
    for (const double most : {0.01, 1.0, 4.0, 100.0, 1e6, 1e8, 1e20})
      judge.range([&] { return real(-most, most); });
    judge.range([&] { return any(); });
    judge.range([&] { return subnormal(); });
    judge.range([&] { return signedMagnitude(1e-30, 1); });
    // Next to multiples of pi/2, and of the steps of the table.
    for (const double step : {std::numbers::pi / 2, std::numbers::pi / 128, std::numbers::pi / 256})
      for (const int most : {10, 100'000, 100'000'000})
        judge.range([&] {
          const double multiple = random_.integer(-most, most) * step;
          return std::bit_cast<double>(std::bit_cast<std::uint64_t>(multiple) + random_.below(3u));
        });
    judge.range([&] { return std::ldexp(std::numbers::pi, random_.integer(-3, 1020)); });
    // The double nearest to a multiple of pi/2: 2^-61 away.
    for (const int exponent : {796, 797, 798}) judge.look(std::ldexp(6381956970095103.0, exponent));
    judge.look(kHugest);
  }
  void shares(Judge& judge) {  // arguments of arc sine and arc cosine
    judge.range([&] { return real(-1, 1); });
    judge.range([&] { return signedMagnitude(1e-30, 1); });
    judge.range([&] { return (random_.oneIn(2) ? 1 : -1) * (1 - random_.magnitude(1e-16, 0.5)); });
    judge.range([&] { return (random_.oneIn(2) ? 0.5 : -0.5) * (1 + signedMagnitude(1e-16, 0.1)); });
    judge.range([&] { return random_.integer(-128, 128) / 128.0 + signedMagnitude(1e-17, 1e-9); });
    judge.range([&] { return any(); });
    judge.range([&] { return subnormal(); });
  }

  Random random_{24};
};

TEST_F(Elementary, ExponentialsAreWithinTheirLimits) {
  Judge exp =
      judge("exp", elementary::exp, mpfr_exp, 0.77);  // where results are subnormal they are rounded twice
  for (const double most : {1e-3, 1.0, 750.0}) exp.range([&] { return real(-most, most); });
  exp.range([&] { return real(-746, -707); });
  exp.range([&] { return real(709, 710); });
  exp.range([&] { return any(); });
  exp.range([&] { return subnormal(); });

  Judge expm1 = judge("expm1", elementary::expm1, mpfr_expm1, 0.7);
  for (const double most : {1e-3, 0.01, 1.0, 40.0, 750.0}) expm1.range([&] { return real(-most, most); });
  expm1.range([&] { return signedMagnitude(1e-30, 1); });
  expm1.range([&] { return any(); });
  expm1.range([&] { return subnormal(); });
}

TEST_F(Elementary, LogarithmsAreWithinTheirLimits) {
  Judge log = judge("log", elementary::log, mpfr_log);
  log.range([&] { return real(0, 2); });
  log.range([&] { return real(0.99, 1.01); });
  log.range([&] { return 1 + signedMagnitude(1e-16, 0.1); });
  log.range([&] { return random_.magnitude(1e-300, 1e300); });
  log.range([&] { return any(); });
  log.range([&] { return subnormal(); });
}

TEST_F(Elementary, PowersAreWithinTheirLimits) {
  Judge pow = judge("pow", elementary::pow, mpfr_pow, 0.77);
  pow.range([&] { return Pair{real(0, 1), real(0, 10)}; });
  pow.range([&] { return Pair{real(0.9, 1.1), real(-1000, 1000)}; });
  pow.range([&] { return Pair{1 + signedMagnitude(1e-16, 0.1), signedMagnitude(1, 1e18)}; });
  pow.range([&] { return Pair{random_.magnitude(1e-300, 1e300), real(-3, 3)}; });
  pow.range([&] { return Pair{any(), any()}; });
  pow.range([&] { return Pair{any(), random_.integer(-10, 10)}; });
  pow.range([&] { return Pair{subnormal(), real(-1, 1)}; });
  for (const double most : {1.0, 700.0, 760.0})  // of the exponent of e
    pow.range([&] {
      const double x = random_.magnitude(1e-10, 1e10);
      return Pair{x, real(-most, most) / std::log(x)};
    });
  pow.range([&] {
    const double x = random_.magnitude(0.5, 2);
    return Pair{x, -real(707, 746) / std::log(x)};
  });
}

TEST_F(Elementary, RootsAreWithinTheirLimits) {
  Judge cbrt = judge("cbrt", elementary::cbrt, mpfr_cbrt);
  cbrt.range([&] { return real(-9, 9); });
  cbrt.range([&] { return any(); });
  cbrt.range([&] { return subnormal(); });
  for (int i = -1000; i <= 1000; ++i) EXPECT_EQ(elementary::cbrt(double(i) * i * i), i);

  // The sum of the squares is rounded before its root.
  Judge hypot = judge("hypot", elementary::hypot, mpfr_hypot, 0.94);
  hypot.range([&] { return Pair{real(-1, 1), real(-1, 1)}; });
  hypot.range([&] { return close(); });
  hypot.range([&] { return Pair{any(), any()}; });
  hypot.range([&] { return Pair{subnormal(), subnormal()}; });
  hypot.range([&] { return Pair{subnormal(), signedMagnitude(1e-308, 1e-300)}; });
  EXPECT_EQ(elementary::hypot(3, -4), 5);
  EXPECT_EQ(elementary::hypot(kHugest, kHugest), kInfinite);
}

TEST_F(Elementary, SinesAreWithinTheirLimits) {
  Judge sin = judge("sin", elementary::sin, mpfr_sin);
  angles(sin);
}
TEST_F(Elementary, CosinesAreWithinTheirLimits) {
  Judge cos = judge("cos", elementary::cos, mpfr_cos);
  angles(cos);
}
TEST_F(Elementary, TangentsAreWithinTheirLimits) {
  Judge tan = judge("tan", elementary::tan, mpfr_tan, 0.57);
  angles(tan);
}

TEST_F(Elementary, ArcSinesAndCosinesAreWithinTheirLimits) {
  Judge asin = judge("asin", elementary::asin, mpfr_asin), acos = judge("acos", elementary::acos, mpfr_acos);
  shares(asin);
  shares(acos);
}

TEST_F(Elementary, ArcTangentsAreWithinTheirLimits) {
  Judge atan = judge("atan", elementary::atan, mpfr_atan);
  for (const double most : {0.01, 1.0, 10.0, 1e6}) atan.range([&] { return real(-most, most); });
  atan.range([&] { return random_.integer(-128, 128) / 128.0 + signedMagnitude(1e-17, 1e-9); });
  atan.range([&] { return signedMagnitude(1e-30, 1e30); });
  atan.range([&] { return any(); });
  atan.range([&] { return subnormal(); });

  Judge atan2 = judge("atan2", elementary::atan2, mpfr_atan2);
  atan2.range([&] { return Pair{real(-1, 1), real(-1, 1)}; });
  atan2.range([&] { return close(); });
  atan2.range([&] { return Pair{any(), any()}; });
  atan2.range([&] { return Pair{subnormal(), subnormal()}; });
  atan2.range([&] { return Pair{subnormal(), signedMagnitude(1e-308, 1)}; });
  atan2.range([&] { return Pair{signedMagnitude(1e-308, 1), subnormal()}; });
}

// ---- special values

// Equal with their signs; NaN is without.
void expectSame(double got, double expected, const char* what) {
  EXPECT_EQ(std::bit_cast<std::uint64_t>(got), std::bit_cast<std::uint64_t>(expected)) << what << ": " << got;
}
#define EXPECT_SAME(expression, expected) expectSame(elementary::expression, expected, #expression)

TEST(ElementarySpecialValues, OfOneArgument) {
  using Function = double (*)(double);
  for (const Function f :
       {elementary::expm1, elementary::sin, elementary::tan, elementary::asin, elementary::atan}) {
    for (const double x : {0.0, kTiniest, 1e-300}) {
      expectSame(f(x), x, "odd");
      expectSame(f(-x), -x, "odd");
    }
  }
  for (const Function f :
       {elementary::exp, elementary::expm1, elementary::log, elementary::cbrt, elementary::sin,
        elementary::cos, elementary::tan, elementary::asin, elementary::acos, elementary::atan}) {
    expectSame(f(kNaN), kNaN, "of NaN");
    expectSame(f(-kNaN), kNaN, "of NaN");
  }
  for (const Function f :
       {elementary::sin, elementary::cos, elementary::tan, elementary::asin, elementary::acos}) {
    expectSame(f(kInfinite), kNaN, "of infinity");
    expectSame(f(-kInfinite), kNaN, "of infinity");
  }
  EXPECT_SAME(exp(0), 1);
  EXPECT_SAME(exp(-0.0), 1);
  EXPECT_SAME(exp(kInfinite), kInfinite);
  EXPECT_SAME(exp(-kInfinite), 0);
  EXPECT_SAME(exp(1e300), kInfinite);
  EXPECT_SAME(exp(-1e300), 0);
  EXPECT_SAME(expm1(kInfinite), kInfinite);
  EXPECT_SAME(expm1(-kInfinite), -1);
  EXPECT_SAME(log(1), 0);
  EXPECT_SAME(log(0), -kInfinite);
  EXPECT_SAME(log(-0.0), -kInfinite);
  EXPECT_SAME(log(-1), kNaN);
  EXPECT_SAME(log(-kInfinite), kNaN);
  EXPECT_SAME(log(kInfinite), kInfinite);
  EXPECT_SAME(cbrt(0), 0);
  EXPECT_SAME(cbrt(-0.0), -0.0);
  EXPECT_SAME(cbrt(kInfinite), kInfinite);
  EXPECT_SAME(cbrt(-kInfinite), -kInfinite);
  EXPECT_SAME(cos(0), 1);
  EXPECT_SAME(cos(-0.0), 1);
  EXPECT_SAME(asin(1.1), kNaN);
  EXPECT_SAME(acos(-1.1), kNaN);
  EXPECT_SAME(acos(1), 0);
  EXPECT_SAME(acos(-1), std::numbers::pi);
  EXPECT_SAME(atan(kInfinite), std::numbers::pi / 2);
  EXPECT_SAME(atan(-kInfinite), -std::numbers::pi / 2);
}

TEST(ElementarySpecialValues, OfHypotenuses) {
  EXPECT_SAME(hypot(0, -0.0), 0);
  EXPECT_SAME(hypot(-2, 0), 2);
  EXPECT_SAME(hypot(kInfinite, kNaN), kInfinite);
  EXPECT_SAME(hypot(kNaN, -kInfinite), kInfinite);
  EXPECT_SAME(hypot(1, kNaN), kNaN);
  EXPECT_SAME(hypot(kNaN, 1), kNaN);
}

TEST(ElementarySpecialValues, OfArcTangentsOfTwo) {
  const double pi = std::numbers::pi;
  for (const double sign : {1.0, -1.0}) {
    expectSame(elementary::atan2(sign * 0.0, 0.0), sign * 0.0, "0, 0");
    expectSame(elementary::atan2(sign * 0.0, -0.0), sign * pi, "0, -0");
    expectSame(elementary::atan2(sign * 0.0, 1), sign * 0.0, "0, 1");
    expectSame(elementary::atan2(sign * 0.0, -1), sign * pi, "0, -1");
    expectSame(elementary::atan2(sign, 0.0), sign * pi / 2, "1, 0");
    expectSame(elementary::atan2(sign, -0.0), sign * pi / 2, "1, -0");
    expectSame(elementary::atan2(sign, kInfinite), sign * 0.0, "1, infinite");
    expectSame(elementary::atan2(sign, -kInfinite), sign * pi, "1, -infinite");
    expectSame(elementary::atan2(sign * kInfinite, 1), sign * pi / 2, "infinite, 1");
    expectSame(elementary::atan2(sign * kInfinite, kInfinite), sign * pi / 4, "infinite, infinite");
    expectSame(elementary::atan2(sign * kInfinite, -kInfinite), sign * 3 * pi / 4, "infinite, -infinite");
  }
  EXPECT_SAME(atan2(kNaN, 1), kNaN);
  EXPECT_SAME(atan2(1, -kNaN), kNaN);
}

TEST(ElementarySpecialValues, OfPowers) {
  for (const double y : {-3.0, -2.0, -1.5}) {
    const bool odd = y == -3;
    expectSame(elementary::pow(0.0, y), kInfinite, "0");
    expectSame(elementary::pow(-0.0, y), odd ? -kInfinite : kInfinite, "-0");
    expectSame(elementary::pow(0.0, -y), 0, "0");
    expectSame(elementary::pow(-0.0, -y), odd ? -0.0 : 0.0, "-0");
    expectSame(elementary::pow(kInfinite, y), 0, "infinite");
    expectSame(elementary::pow(-kInfinite, y), odd ? -0.0 : 0.0, "-infinite");
    expectSame(elementary::pow(kInfinite, -y), kInfinite, "infinite");
    expectSame(elementary::pow(-kInfinite, -y), odd ? -kInfinite : kInfinite, "-infinite");
  }
  for (const double x : {0.0, -0.0, 1.0, -7.0, kInfinite, kNaN}) {
    expectSame(elementary::pow(x, 0), 1, "to 0");
    expectSame(elementary::pow(x, -0.0), 1, "to 0");
    expectSame(elementary::pow(1, x), 1, "of 1");
  }
  for (const double x : {0.5, -0.5, 0.0, -0.0}) {
    expectSame(elementary::pow(x, kInfinite), 0, "small");
    expectSame(elementary::pow(x, -kInfinite), kInfinite, "small");
  }
  for (const double x : {1.5, -1.5, kInfinite, -kInfinite}) {
    expectSame(elementary::pow(x, kInfinite), kInfinite, "large");
    expectSame(elementary::pow(x, -kInfinite), 0, "large");
  }
  EXPECT_SAME(pow(-1, kInfinite), 1);
  EXPECT_SAME(pow(-1, -kInfinite), 1);
  EXPECT_SAME(pow(-2, 3), -8);
  EXPECT_SAME(pow(-2, 4), 16);
  EXPECT_SAME(pow(-2, 0.5), kNaN);
  EXPECT_SAME(pow(-2, 0x1p53 + 2), kInfinite);
  EXPECT_SAME(pow(kNaN, 1), kNaN);
  EXPECT_SAME(pow(2, -kNaN), kNaN);
  EXPECT_SAME(pow(2, 1e300), kInfinite);
  EXPECT_SAME(pow(2, -1e300), 0);
  EXPECT_SAME(pow(2, 1e-300), 1);
  for (int i = -1074; i < 1024; ++i) EXPECT_EQ(elementary::pow(2, i), std::ldexp(1, i));
}

}  // namespace
}  // namespace rayshade
