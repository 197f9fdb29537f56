// Which field of two values differs first, by the list of their fields (fields.hpp): for reports and tests' messages.
//
//   core::first_difference(a, b)     // "solids[2].nodes[17].vx: 0.012 and 0.0125", or nothing
//
// Numbers are compared by their bits. What is not in use does not count, and what is not hashed neither.
#pragma once

#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <vector>

#include <trocar/core/fields.hpp>

namespace trocar::core {

/// Numbers with as many digits as tell two of them apart.
std::string exact_text(double value);
std::string exact_text(float value);
std::string exact_text(long long value);
std::string exact_text(const std::string& x, const std::string& y, const std::string& z);

namespace detail {

/// Where a value's fields are, in the order of their list.
struct FieldPlaces {
  std::vector<const void*> places;
  std::vector<std::ptrdiff_t> in_use;

  template <class F>
  void operator()(const char* /*name*/, const F& field, const FieldNote& note = {}) {
    places.push_back(&field);
    in_use.push_back(note.first);
  }
  template <class F>
  void operator()(const char* /*name*/, const F& /*field*/, NotHashed /*note*/) {}
  template <class F>
  void operator()(const char* /*name*/, const F& /*field*/, PartOfField /*note*/) {}
};

template <class T>
concept Number = std::is_arithmetic_v<T> || std::is_enum_v<T>;
template <class T>
concept Point = requires(const T& p) {
  p.x, p.y, p.z;
}
&&!Listed<T>;

/// A number with a meaning, such as a BodyId.
template <class T>
concept Coded = requires(const T& p) {
  p.code();
}
&&!Listed<T>;

template <class F>
std::string text_of(const F& value) {
  if constexpr (std::is_floating_point_v<F>) return exact_text(value);
  if constexpr (std::is_integral_v<F> || std::is_enum_v<F>) return exact_text(static_cast<long long>(value));
  if constexpr (Coded<F>) return exact_text(static_cast<long long>(value.code()));
  if constexpr (Point<F>) return exact_text(text_of(value.x), text_of(value.y), text_of(value.z));
  return {};
}

template <class F>
std::string difference(const F& a, const F& b, const std::string& path, bool loose);

template <class E>
std::string difference(const E* a, const E* b, std::size_t count, const std::string& path, bool loose) {
  if constexpr (Bytes<E>)
    if (count == 0 || std::memcmp(static_cast<const void*>(a), static_cast<const void*>(b), count * sizeof(E)) == 0)
      return {};
  for (std::size_t i = 0; i < count; ++i)
    if (std::string d = difference(a[i], b[i], path + "[" + std::to_string(i) + "]", loose); !d.empty()) return d;
  return {};
}

/// Goes through the second value's list beside the first one's places.
class FieldComparer {
 public:
  FieldComparer(const FieldPlaces& first, const std::string& path, bool loose)
      : m_first(first), m_path(path), m_loose(loose) {}

  template <class F>
  void operator()(const char* name, const F& field, const FieldNote& note = {}) {
    const std::size_t i = m_next++;
    if (!m_text.empty() || (note.loose && !m_loose)) return;
    const std::string path = m_path.empty() ? name : m_path + "." + name;
    compare(*static_cast<const F*>(m_first.places[i]), field, std::min(m_first.in_use[i], note.first), path);
  }
  template <class F>
  void operator()(const char* /*name*/, const F& /*field*/, NotHashed /*note*/) {}
  template <class F>
  void operator()(const char* /*name*/, const F& /*field*/, PartOfField /*note*/) {}

  const std::string& text() const { return m_text; }

 private:
  template <class E>
  void compare(const std::vector<E>& a, const std::vector<E>& b, std::ptrdiff_t in_use, const std::string& path) {
    if (a.size() != b.size())
      m_text = path + ".size: " + std::to_string(a.size()) + " and " + std::to_string(b.size());
    else
      m_text = difference(a.data(), b.data(), in_use < 0 ? a.size() : std::size_t(in_use), path, m_loose);
  }
  template <class E, std::size_t N>
  void compare(const E (&a)[N], const E (&b)[N], std::ptrdiff_t in_use, const std::string& path) {
    m_text = difference(a, b, in_use < 0 ? N : std::size_t(in_use), path, m_loose);
  }
  template <class E, std::size_t N>
  void compare(const std::array<E, N>& a, const std::array<E, N>& b, std::ptrdiff_t in_use, const std::string& path) {
    m_text = difference(a.data(), b.data(), in_use < 0 ? N : std::size_t(in_use), path, m_loose);
  }
  template <class F>
  void compare(const F& a, const F& b, std::ptrdiff_t /*in_use*/, const std::string& path) {
    m_text = difference(a, b, path, m_loose);
  }

  const FieldPlaces& m_first;
  const std::string& m_path;
  bool m_loose;
  std::size_t m_next = 0;
  std::string m_text;
};

template <class E>
struct IsVector : std::false_type {};
template <class E>
struct IsVector<std::vector<E>> : std::true_type {};

template <class F>
std::string difference(const F& a, const F& b, const std::string& path, bool loose) {
  if constexpr (IsVector<F>::value) {
    if (a.size() != b.size()) return path + ".size: " + std::to_string(a.size()) + " and " + std::to_string(b.size());
    return difference(a.data(), b.data(), a.size(), path, loose);
  } else if constexpr (Listed<F>) {
    FieldPlaces places;
    F::fields(a, places);
    FieldComparer comparer(places, path, loose);
    F::fields(b, comparer);
    return comparer.text();
  } else {
    static_assert(Bytes<F>);
    if (std::memcmp(static_cast<const void*>(&a), static_cast<const void*>(&b), sizeof(F)) == 0) return {};
    if constexpr (Number<F> || Coded<F> || Point<F>) return path + ": " + text_of(a) + " and " + text_of(b);
    return path;
  }
}

}  // namespace detail

/// Nothing where they are equal. What may differ where it is not in use is looked at last.
template <class T>
std::string first_difference(const T& a, const T& b) {
  const std::string strict = detail::difference(a, b, {}, false);
  return strict.empty() ? detail::difference(a, b, {}, true) : strict;
}

}  // namespace trocar::core
