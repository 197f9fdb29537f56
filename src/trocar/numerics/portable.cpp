// How: each argument is brought into a small interval (Cody and Waite's splitting of the constant, so that the product
// with a small integer is exact), where the Taylor series, cut below 2^-60 of the result, is evaluated by Horner's
// rule. [Cody & Waite 1980, Software Manual for the Elementary Functions]
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include <trocar/numerics/portable.hpp>

namespace trocar::portable {
namespace {

// pi/2 in three parts of 33, 33 and 53 bits: n * part is exact for |n| < 2^20.
constexpr double kHalfPi1 = 0x1.921fb54400000p+0;
constexpr double kHalfPi2 = 0x1.0b4611a600000p-34;
constexpr double kHalfPi3 = 0x1.3198a2e037073p-69;
// ln 2 in 40 bits and the rest: n * part is exact for |n| < 2^13.
constexpr double kLn2High = 0x1.62e42fefa4000p-1;
constexpr double kLn2Low = -0x1.8432a1b0e2634p-43;
// What the nearest doubles to pi and pi/2 lack.
constexpr double kHalfPi = 0x1.921fb54442d18p+0;
constexpr double kPiLow = 0x1.1a62633145c07p-53;

// An angle in [-pi/4, pi/4] as an unevaluated sum, and the number of quarter turns taken from it.
struct Reduced {
  double high, low;
  int quarter;
};

Reduced reduce(double x) noexcept {
  const double n = std::floor(x * 0.63661977236758134308 + 0.5);
  const double first = x - n * kHalfPi1;
  const double second = n * kHalfPi2;
  const double rest = first - second;
  const double lost = (first - rest) - second;
  const double tail = lost - n * kHalfPi3;
  const double high = rest + tail;
  return {high, (rest - high) + tail, static_cast<int>(static_cast<std::int64_t>(n) & 3)};
}

// sin(r.high + r.low) on the small interval: series to x^17.
double sin_small(const Reduced& r) noexcept {
  const double x = r.high, z = x * x;
  double p = 1.0 / 355687428096000.0;
  p = p * z - 1.0 / 1307674368000.0;
  p = p * z + 1.0 / 6227020800.0;
  p = p * z - 1.0 / 39916800.0;
  p = p * z + 1.0 / 362880.0;
  p = p * z - 1.0 / 5040.0;
  p = p * z + 1.0 / 120.0;
  p = p * z - 1.0 / 6.0;
  return x + (x * z * p + r.low * (1.0 - 0.5 * z));
}

// cos(r.high + r.low) on the small interval: series to x^18.
double cos_small(const Reduced& r) noexcept {
  const double x = r.high, z = x * x;
  double p = -1.0 / 6402373705728000.0;
  p = p * z + 1.0 / 20922789888000.0;
  p = p * z - 1.0 / 87178291200.0;
  p = p * z + 1.0 / 479001600.0;
  p = p * z - 1.0 / 3628800.0;
  p = p * z + 1.0 / 40320.0;
  p = p * z - 1.0 / 720.0;
  p = p * z + 1.0 / 24.0;
  const double half = 0.5 * z, one = 1.0 - half;
  return one + (((1.0 - one) - half) + (z * z * p - x * r.low));
}

double sin_quarter(const Reduced& r, int quarter) noexcept {
  switch (quarter & 3) {
    case 0:
      return sin_small(r);
    case 1:
      return cos_small(r);
    case 2:
      return -sin_small(r);
    default:
      return -cos_small(r);
  }
}

// atan(k/16) as the nearest double and what it lacks.
constexpr double kAtan[17][2] = {
    {0x0.0p+0, 0x0.0p+0},
    {0x1.ff55bb72cfdeap-5, -0x1.c934d86d23f1dp-60},
    {0x1.fd5ba9aac2f6ep-4, -0x1.cd37686760c17p-59},
    {0x1.7b97b4bce5b02p-3, 0x1.347b0b4f881cap-58},
    {0x1.f5b75f92c80ddp-3, 0x1.8ab6e3cf7afbdp-57},
    {0x1.362773707ebccp-2, -0x1.963a544b672d8p-57},
    {0x1.6f61941e4def1p-2, -0x1.c63aae6f6e918p-56},
    {0x1.a64eec3cc23fdp-2, -0x1.24dec1b50b7ffp-56},
    {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56},
    {0x1.0657e94db30d0p-1, -0x1.d5b495f6349e6p-56},
    {0x1.1e00babdefeb4p-1, -0x1.928df287a668fp-58},
    {0x1.345f01cce37bbp-1, 0x1.1021137c71102p-55},
    {0x1.4978fa3269ee1p-1, 0x1.2419a87f2a458p-56},
    {0x1.5d58987169b18p-1, 0x1.0028e4bc5e7cap-57},
    {0x1.700a7c5784634p-1, -0x1.8c34d25aadef6p-56},
    {0x1.819d0b7158a4dp-1, -0x1.bf76229d3b917p-56},
    {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55},
};

struct Sum {
  double high, low;
};

// atan(small/large) for 0 <= small <= large, large > 0: atan c + atan((t - c)/(1 + t c)) with c the nearest k/16.
Sum atan_octant(double small, double large) noexcept {
  const int k = static_cast<int>(16.0 * (small / large) + 0.5);
  const double c = k / 16.0;
  const double u = k == 0 ? small / large : (small - c * large) / (large + c * small);
  const double z = u * u;
  double p = -1.0 / 15.0;
  p = p * z + 1.0 / 13.0;
  p = p * z - 1.0 / 11.0;
  p = p * z + 1.0 / 9.0;
  p = p * z - 1.0 / 7.0;
  p = p * z + 1.0 / 5.0;
  p = p * z - 1.0 / 3.0;
  return {kAtan[k][0], kAtan[k][1] + (u + u * z * p)};
}

double power_of_two(int n) noexcept {  // -1022 <= n <= 1023
  const std::uint64_t bits = static_cast<std::uint64_t>(n + 1023) << 52;
  double value;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

// x > 0, finite: x = m 2^exponent with m in [1, 2).
double split_exponent(double x, int& exponent) noexcept {
  int shift = 0;
  if (x < std::numeric_limits<double>::min()) {
    x *= 0x1p54;
    shift = -54;
  }
  std::uint64_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  exponent = static_cast<int>(bits >> 52) - 1023 + shift;
  bits = (bits & 0x000fffffffffffffull) | 0x3ff0000000000000ull;
  std::memcpy(&x, &bits, sizeof x);
  return x;
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

double sin(double x) noexcept {
  if (!(std::fabs(x) <= 1e9)) return kNan;  // beyond it the quarter turns no longer fit; accurate to 1e4
  if (std::fabs(x) < 0x1p-27) return x;
  const Reduced r = reduce(x);
  return sin_quarter(r, r.quarter);
}

double cos(double x) noexcept {
  if (!(std::fabs(x) <= 1e9)) return kNan;
  const Reduced r = reduce(x);
  return sin_quarter(r, r.quarter + 1);
}

double atan2(double y, double x) noexcept {
  if (x != x || y != y) return kNan;
  double ax = std::fabs(x), ay = std::fabs(y);
  if (ax == kInfinity || ay == kInfinity) {
    ax = ax == kInfinity ? 1.0 : 0.0;
    ay = ay == kInfinity ? 1.0 : 0.0;
  }
  if (ax > 0x1p1000 || ay > 0x1p1000) {
    ax *= 0x1p-30;
    ay *= 0x1p-30;
  }
  Sum angle{0.0, 0.0};
  if (ay > ax) {
    angle = atan_octant(ax, ay);
    angle = {kHalfPi - angle.high, 0.5 * kPiLow - angle.low};
  } else if (ax > 0.0) {
    angle = atan_octant(ay, ax);
  }
  double result = angle.high + angle.low;
  if (std::signbit(x)) result = (pi - angle.high) + (kPiLow - angle.low);
  return std::copysign(result, y);
}

double acos(double x) noexcept {
  if (x > 1.0) x = 1.0;
  if (x < -1.0) x = -1.0;
  return atan2(std::sqrt((1.0 - x) * (1.0 + x)), x);
}

double asin(double x) noexcept {
  if (x > 1.0) x = 1.0;
  if (x < -1.0) x = -1.0;
  return atan2(x, std::sqrt((1.0 - x) * (1.0 + x)));
}

double exp(double x) noexcept {
  if (x != x) return x;
  if (x < -708.0) return 0.0;
  if (x > 709.0) x = 709.0;
  const double n = std::floor(x * 1.44269504088896340736 + 0.5);
  const double high = x - n * kLn2High;
  const double low = n * kLn2Low;
  const double r = high - low;
  const double correction = (high - r) - low;
  double p = 1.0 / 87178291200.0;
  p = p * r + 1.0 / 6227020800.0;
  p = p * r + 1.0 / 479001600.0;
  p = p * r + 1.0 / 39916800.0;
  p = p * r + 1.0 / 3628800.0;
  p = p * r + 1.0 / 362880.0;
  p = p * r + 1.0 / 40320.0;
  p = p * r + 1.0 / 5040.0;
  p = p * r + 1.0 / 720.0;
  p = p * r + 1.0 / 120.0;
  p = p * r + 1.0 / 24.0;
  p = p * r + 1.0 / 6.0;
  p = p * r + 0.5;
  return (1.0 + (r + (r * r * p + correction))) * power_of_two(static_cast<int>(n));
}

double log(double x) noexcept {
  if (x != x || x < 0.0) return kNan;
  if (x == 0.0) return -kInfinity;
  if (x == kInfinity) return kInfinity;
  int exponent;
  double m = split_exponent(x, exponent);
  if (m > 1.41421356237309504880) {
    m *= 0.5;
    ++exponent;
  }
  // log m = 2 atanh s, s = (m-1)/(m+1); written as f - s (f - 2 s^2 (1/3 + ...)) because f = m-1 is exact.
  const double f = m - 1.0, s = f / (2.0 + f), z = s * s;
  double p = 1.0 / 25.0;
  for (int odd = 23; odd >= 3; odd -= 2) p = p * z + 1.0 / odd;
  const double n = exponent;
  return n * kLn2High + (f - (s * (f - 2.0 * z * p) - n * kLn2Low));
}

}  // namespace trocar::portable
