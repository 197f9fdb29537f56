// A State as bytes, by the list of its fields (core/fields.hpp), so that a long test can stop and resume exactly.
//
//   Saver saver(stream);  sim::State::fields(state, saver);
//   Loader loader(stream);  sim::State::fields(state, loader);      // of a State of the same Model
#pragma once

#include <array>
#include <cstdint>
#include <istream>
#include <ostream>
#include <vector>

#include <trocar/core/fields.hpp>

namespace trocar {

/// @tparam Own  how bytes go: Saver or Loader
template <class Own>
class StateBytes {
 public:
  template <class F, class N = core::FieldNote>
  void operator()(const char* /*name*/, F& field, N /*note*/ = {}) {
    if constexpr (!std::is_same_v<N, core::PartOfField>) visit(field);
  }

 protected:
  template <class E>
  void visit(E& value) {
    using T = std::remove_const_t<E>;
    if constexpr (core::Bytes<T>)
      own().bytes(&value, sizeof value);
    else
      T::fields(value, own());
  }
  template <class E>
  void visit(std::vector<E>& items) {
    own().size(items);
    visit_all(items);
  }
  template <class E>
  void visit(const std::vector<E>& items) {
    own().size(items);
    visit_all(items);
  }
  template <class E, std::size_t N>
  void visit(std::array<E, N>& items) {
    visit_all(items);
  }
  template <class E, std::size_t N>
  void visit(const std::array<E, N>& items) {
    visit_all(items);
  }

 private:
  Own& own() { return static_cast<Own&>(*this); }
  template <class Items>
  void visit_all(Items& items) {
    using E = std::remove_const_t<typename Items::value_type>;
    if constexpr (core::Bytes<E>) {
      if (!items.empty()) own().bytes(items.data(), items.size() * sizeof(E));
    } else {
      for (auto& item : items) visit(item);
    }
  }
};

class Saver : public StateBytes<Saver> {
 public:
  explicit Saver(std::ostream& out) : m_out(out) {}
  void bytes(const void* data, std::size_t size) { m_out.write(static_cast<const char*>(data), std::streamsize(size)); }
  template <class E>
  void size(const std::vector<E>& items) {
    const std::uint64_t count = items.size();
    bytes(&count, sizeof count);
  }

 private:
  std::ostream& m_out;
};

class Loader : public StateBytes<Loader> {
 public:
  explicit Loader(std::istream& in) : m_in(in) {}
  void bytes(void* data, std::size_t size) { m_in.read(static_cast<char*>(data), std::streamsize(size)); }
  template <class E>
  void size(std::vector<E>& items) {
    std::uint64_t count = 0;
    bytes(&count, sizeof count);
    if (m_in && count < (1u << 28)) items.resize(std::size_t(count));
  }

 private:
  std::istream& m_in;
};

}  // namespace trocar
