// Halton's sequence: points that fill a cube evenly, the same ones every time [Halton 1960].
#pragma once

namespace trocar::studies {

/// @param index  from 1  @param axis  any; beyond the sixteenth axes repeat
inline double halton(int index, int axis) noexcept {
  constexpr int kPrimes[] = {2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41, 43, 47, 53};
  const int base = kPrimes[axis % 16];
  double value = 0, digit = 1;
  for (int i = index; i > 0; i /= base) {
    digit /= base;
    value += digit * (i % base);
  }
  return value;
}

}  // namespace trocar::studies
