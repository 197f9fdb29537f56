// The discrete Fourier transform of real signals whose length is (padded to) a power of two.
//
//   const std::vector<double> m = magnitude_spectrum(speed, fft_size(speed.size()));   // |X_k|, k = 0 .. n/2
//
// Why our own: what a trainee's score rests on must have the same bits on every machine. Libraries (FFTW, kissfft
// behind Eigen) take sines from libm and choose kernels by processor; a radix-2 transform [Cooley & Tukey 1965] with
// portable sines is forty lines, and an attempt needs a few hundred transforms of about a thousand points:
// milliseconds.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace trocar::numerics {

struct Complex {
  double re = 0, im = 0;
};

inline constexpr std::size_t kMaxFft = std::size_t(1) << 20;

/// The smallest power of two that is >= n; at least 1.
std::size_t fft_size(std::size_t n) noexcept;

/// X_k = sum_j x_j exp(-2 pi i j k / n), in place. x.size() is a power of two, at most kMaxFft.
/// @throws std::invalid_argument for another size
void fft(std::span<Complex> x);

/// |X_k| for k = 0 .. n/2 of x padded with zeros to n (a power of two >= x.size()).
std::vector<double> magnitude_spectrum(std::span<const double> x, std::size_t n);

}  // namespace trocar::numerics
