#include <cmath>
#include <stdexcept>
#include <utility>

#include <trocar/numerics/fft.hpp>
#include <trocar/numerics/portable.hpp>

namespace trocar::numerics {
namespace {

/// Moves x_j to where the bits of j, read backwards, say.
void reverse_bits(std::span<Complex> x) {
  for (std::size_t i = 1, j = 0; i < x.size(); ++i) {
    std::size_t bit = x.size() >> 1;
    for (; (j & bit) != 0; bit >>= 1) j ^= bit;
    j |= bit;
    if (i < j) std::swap(x[i], x[j]);
  }
}

/// exp(-2 pi i k / n) for k < n/2.
std::vector<Complex> roots(std::size_t n) {
  std::vector<Complex> w(n / 2);
  for (std::size_t k = 0; k < w.size(); ++k) {
    const double angle = 2 * portable::pi * double(k) / double(n);
    w[k] = {portable::cos(angle), -portable::sin(angle)};
  }
  return w;
}

}  // namespace

std::size_t fft_size(std::size_t n) noexcept {
  std::size_t size = 1;
  while (size < n) size <<= 1;
  return size;
}

void fft(std::span<Complex> x) {
  const std::size_t n = x.size();
  if (n == 0 || (n & (n - 1)) != 0 || n > kMaxFft) throw std::invalid_argument("fft: the size must be a power of two");
  reverse_bits(x);
  const std::vector<Complex> w = roots(n);
  for (std::size_t half = 1; half < n; half <<= 1)
    for (std::size_t block = 0; block < n; block += 2 * half)
      for (std::size_t k = 0; k < half; ++k) {
        const Complex root = w[k * (n / (2 * half))];
        Complex &a = x[block + k], &b = x[block + k + half];
        const Complex turned{b.re * root.re - b.im * root.im, b.re * root.im + b.im * root.re};
        b = {a.re - turned.re, a.im - turned.im};
        a = {a.re + turned.re, a.im + turned.im};
      }
}

std::vector<double> magnitude_spectrum(std::span<const double> x, std::size_t n) {
  if (x.size() > n) throw std::invalid_argument("magnitude_spectrum: more samples than points");
  std::vector<Complex> padded(n);
  for (std::size_t i = 0; i < x.size(); ++i) padded[i].re = x[i];
  fft(padded);
  std::vector<double> magnitude(n / 2 + 1);
  for (std::size_t k = 0; k < magnitude.size(); ++k)
    magnitude[k] = std::sqrt(padded[k].re * padded[k].re + padded[k].im * padded[k].im);
  return magnitude;
}

}  // namespace trocar::numerics
