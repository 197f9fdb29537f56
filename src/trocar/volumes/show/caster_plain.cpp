// The caster's lanes in plain C++, for every machine.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>

#include <trocar/volumes/show/caster_kernel.hpp>

namespace trocar::volumes {
namespace {
namespace plain {

template <class T>
struct Eight {
  T v[8];
};
using F = Eight<float>;
using I = Eight<std::int32_t>;
using M = Eight<bool>;

template <class A, class Op>
inline auto each(const A& a, Op op) {
  Eight<decltype(op(a.v[0]))> out;
  for (int i = 0; i < 8; ++i) out.v[i] = op(a.v[i]);
  return out;
}
template <class A, class B, class Op>
inline auto each(const A& a, const B& b, Op op) {
  Eight<decltype(op(a.v[0], b.v[0]))> out;
  for (int i = 0; i < 8; ++i) out.v[i] = op(a.v[i], b.v[i]);
  return out;
}
template <class T>
inline Eight<T> all(T value) {
  Eight<T> out;
  for (T& v : out.v) v = value;
  return out;
}
inline F operator+(const F& a, const F& b) {
  return each(a, b, [](float x, float y) { return x + y; });
}
inline F operator-(const F& a, const F& b) {
  return each(a, b, [](float x, float y) { return x - y; });
}
inline F operator*(const F& a, const F& b) {
  return each(a, b, [](float x, float y) { return x * y; });
}
inline F operator/(const F& a, const F& b) {
  return each(a, b, [](float x, float y) { return x / y; });
}
inline I operator+(const I& a, const I& b) {
  return each(a, b, [](std::int32_t x, std::int32_t y) { return std::int32_t(std::uint32_t(x) + std::uint32_t(y)); });
}
inline I operator-(const I& a, const I& b) {
  return each(a, b, [](std::int32_t x, std::int32_t y) { return x - y; });
}
inline I operator*(const I& a, const I& b) {
  return each(a, b, [](std::int32_t x, std::int32_t y) { return std::int32_t(std::uint32_t(x) * std::uint32_t(y)); });
}
inline F lesser_of(const F& a, const F& b) {
  return each(a, b, [](float x, float y) { return x < y ? x : y; });
}
inline F greater_of(const F& a, const F& b) {
  return each(a, b, [](float x, float y) { return x > y ? x : y; });
}
inline I lesser_of(const I& a, const I& b) {
  return each(a, b, [](std::int32_t x, std::int32_t y) { return x < y ? x : y; });
}
inline F absolute(const F& a) {
  return each(a, [](float x) { return std::fabs(x); });
}
inline F root(const F& a) {
  return each(a, [](float x) { return std::sqrt(x); });
}
inline I whole(const F& a) {
  return each(a, [](float x) { return std::int32_t(x); });
}
inline F real(const I& a) {
  return each(a, [](std::int32_t x) { return float(x); });
}
inline I bits_of(const I& a, int shift, int mask) {
  return each(a, [=](std::int32_t x) { return std::int32_t(std::uint32_t(x) >> shift) & mask; });
}
inline M less(const F& a, const F& b) {
  return each(a, b, [](float x, float y) { return x < y; });
}
inline M is_zero(const I& a) {
  return each(a, [](std::int32_t x) { return x == 0; });
}
inline M both(const M& a, const M& b) {
  return each(a, b, [](bool x, bool y) { return x && y; });
}
inline bool any(const M& m) {
  return std::any_of(m.v, m.v + 8, [](bool x) { return x; });
}
inline F pick(const M& m, const F& a, const F& b) {
  F out;
  for (int i = 0; i < 8; ++i) out.v[i] = m.v[i] ? a.v[i] : b.v[i];
  return out;
}
inline void pair_at(const std::int16_t* from, const I& at, F& low, F& high) {
  for (int i = 0; i < 8; ++i) low.v[i] = from[at.v[i]], high.v[i] = from[at.v[i] + 1];
}
inline F entry_of(const float* from, const I& at) {
  return each(at, [=](std::int32_t i) { return from[i]; });
}
inline I byte_at(const std::uint8_t* from, const I& at) {
  return each(at, [=](std::int32_t i) { return std::int32_t(from[i]); });
}
inline I cell_of(const F& at, int cells) {
  return each(at,
              [=](float x) { return std::clamp(std::int32_t(std::clamp(x, 0.0f, 1e6f)) / kCellEdge, 0, cells - 1); });
}
inline I lane_x() { return {{0, 1, 2, 3, 0, 1, 2, 3}}; }
inline I lane_y() { return {{0, 0, 0, 0, 1, 1, 1, 1}}; }
inline void store(std::int32_t* to, const I& a) { std::copy(a.v, a.v + 8, to); }
inline void store(float* to, const F& a) { std::copy(a.v, a.v + 8, to); }

#include "caster_kernel.inl"

}  // namespace plain
}  // namespace

const CasterKernel* caster_plain() noexcept {
  static const CasterKernel kernel{"plain", plain::cast_tile};
  return &kernel;
}

}  // namespace trocar::volumes
