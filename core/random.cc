#include "sidestep/core/random.h"

#include <cmath>
#include <numbers>

namespace sidestep {
namespace {

// sum of terms[k] x^k
template <int kCount>
double Polynomial(const double (&terms)[kCount], double x) {
  double sum = 0;
  for (int k = kCount - 1; k >= 0; --k) sum = sum * x + terms[k];
  return sum;
}

// The natural logarithm of x in (0, 1]: x = m 2^e with m about 1, and
// log m = 2 atanh((m - 1) / (m + 1)) by its series, whose argument is at most 0.172.
double Log(double x) {
  constexpr double kSeries[] = {1,       1. / 3,  1. / 5,  1. / 7,  1. / 9,  1. / 11,
                                1. / 13, 1. / 15, 1. / 17, 1. / 19, 1. / 21, 1. / 23};
  constexpr double kLn2High = 0x1.62e42feep-1;  // 32 bits, so that its multiples are exact
  constexpr double kLn2Low = 0x1.a39ef35793c76p-33;
  int exponent = 0;
  double mantissa = std::frexp(x, &exponent);
  if (mantissa < std::numbers::sqrt2 / 2) {
    mantissa *= 2;
    --exponent;
  }
  const double s = (mantissa - 1) / (mantissa + 1);
  return exponent * kLn2High + (2 * s * Polynomial(kSeries, s * s) + exponent * kLn2Low);
}

// cos(2 pi turns) for turns in [0, 1): the rest to the nearest quarter of a turn, which is exact,
// is at most pi/4, where the Taylor series of sine and cosine are short.
double CosOfTurns(double turns) {
  constexpr double kCosine[] = {1,
                                -1. / 2,
                                1. / 24,
                                -1. / 720,
                                1. / 40320,
                                -1. / 3628800,
                                1. / 479001600,
                                -1. / 87178291200,
                                1. / 20922789888000};
  constexpr double kSine[] = {1,
                              -1. / 6,
                              1. / 120,
                              -1. / 5040,
                              1. / 362880,
                              -1. / 39916800,
                              1. / 6227020800,
                              -1. / 1307674368000,
                              1. / 355687428096000};
  const double quarters = std::floor(4 * turns + 0.5);
  const double angle_rad = 2 * std::numbers::pi * (turns - quarters / 4);
  const double squared = angle_rad * angle_rad;
  switch (static_cast<int>(quarters) % 4) {
    case 0:
      return Polynomial(kCosine, squared);
    case 1:
      return -angle_rad * Polynomial(kSine, squared);
    case 2:
      return -Polynomial(kCosine, squared);
    default:
      return angle_rad * Polynomial(kSine, squared);
  }
}

}  // namespace

double RandomStream::Normal() {
  const double radius = std::sqrt(-2 * Log(1 - Uniform()));
  return radius * CosOfTurns(Uniform());
}

}  // namespace sidestep
