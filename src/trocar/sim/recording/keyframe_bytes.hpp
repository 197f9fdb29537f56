// How a keyframe's numbers are written as bytes and read again: places as steps of 0.01 mm from where they were drawn.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

#include <trocar/numerics/vec3.hpp>

namespace trocar::sim::keyframe {

template <class T>
void put(std::vector<std::uint8_t>& out, const T* data, size_t count) {
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(data);
  out.insert(out.end(), bytes, bytes + count * sizeof(T));
}

inline constexpr double kStep = 1e-5;  // [m] a picture needs no finer places than 0.01 mm

/// Places as whole steps from where they were drawn, in as few bytes as each takes: most of a scene hardly moves.
inline void put_place(std::vector<std::uint8_t>& out, Vec3d place, Vec3d drawn) {
  for (int k = 0; k < 3; ++k) {
    double steps = (place[k] - drawn[k]) / kStep;
    if (!(std::fabs(steps) < 2e9)) steps = 0;  // not a place: the step has flagged it
    const auto q = std::int64_t(std::floor(steps + 0.5));
    auto bits = std::uint64_t(q < 0 ? -2 * q - 1 : 2 * q);
    for (; bits >= 128; bits >>= 7) out.push_back(std::uint8_t(bits | 128u));
    out.push_back(std::uint8_t(bits));
  }
}

/// Reads from a keyframe; remembers whether there was always enough.
struct Source {
  const std::vector<std::uint8_t>& bytes;
  size_t at = 0;
  bool good = true;

  template <class T>
  void take(T* data, size_t count) {
    const size_t n = count * sizeof(T);
    good = good && bytes.size() - at >= n;
    if (!good || n == 0) return;  // nothing may have no place
    std::memcpy(data, bytes.data() + at, n);
    at += n;
  }

  Vec3d take_place(Vec3d drawn) {
    for (int k = 0; k < 3; ++k) {
      std::uint64_t bits = 0;
      for (int shift = 0;; shift += 7) {
        std::uint8_t byte = 0;
        take(&byte, 1);
        good = good && shift < 35;
        if (!good) return drawn;
        bits |= std::uint64_t(byte & 127u) << shift;
        if (byte < 128) break;
      }
      const auto half = std::int64_t(bits >> 1);
      drawn[k] += kStep * double(bits & 1u ? -half - 1 : half);
    }
    return drawn;
  }
};

/// Numbers that differ from what they were when uncut, each with its place; first how many there are.
template <class T>
void put_changes(std::vector<std::uint8_t>& out, const std::vector<T>& now, const std::vector<T>& uncut, size_t count) {
  std::vector<std::uint32_t> changed;
  for (size_t i = 0; i < count; ++i)
    if (!(now[i] == uncut[i])) changed.push_back(std::uint32_t(i));
  const auto n = std::uint32_t(changed.size());
  put(out, &n, 1);
  for (const std::uint32_t i : changed) {
    put(out, &i, 1);
    put(out, &now[i], 1);
  }
}
template <class T>
void take_changes(Source& in, std::vector<T>& now, size_t count) {
  std::uint32_t n = 0, i = 0;
  in.take(&n, 1);
  in.good = in.good && n <= count;
  for (std::uint32_t k = 0; in.good && k < n; ++k) {
    in.take(&i, 1);
    in.good = in.good && i < count;
    if (in.good) in.take(&now[i], 1);
  }
}

/// Pulse, bleeding, clips: small beside the tissue.
template <class F>
void for_flow(F&& each, auto& s) {
  each(s.flow.p), each(s.flow.q), each(s.flow.openings);
}

}  // namespace trocar::sim::keyframe
