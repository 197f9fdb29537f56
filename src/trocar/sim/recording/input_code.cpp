#include <array>
#include <cstring>

#include <trocar/sim/recording/input_code.hpp>

namespace trocar::sim {
namespace {

constexpr std::size_t kWords = sizeof(Input) / 4;
using Words = std::array<std::uint32_t, kWords>;
static_assert(kWords <= 64, "the mask of changed fields has 64 bits");

Words words_of(const Input& input) {
  Words words;
  std::memcpy(words.data(), &input, sizeof input);
  return words;
}

Input input_of(const Words& words) {
  Input input;
  std::memcpy(static_cast<void*>(&input), words.data(), sizeof input);
  return input;
}

}  // namespace

InputCode::InputCode() : m_last(input_of({})) {}

void InputCode::reserve(std::uint64_t ticks) { m_bytes.reserve(ticks * (5 + 5 * kWords)); }

void InputCode::add(const Input& input) {
  const Words last = words_of(m_last), now = words_of(input);
  std::uint64_t mask = 0;
  for (std::size_t i = 0; i < kWords; ++i) mask |= std::uint64_t(last[i] != now[i]) << i;
  ++m_count;
  if (mask == 0) {
    ++m_unchanged;
    return;
  }
  end_run();
  core::put_varint(m_bytes, mask);
  for (std::size_t i = 0; i < kWords; ++i)
    if (mask >> i & 1) core::put_varint(m_bytes, last[i] ^ now[i]);
  m_last = input;
}

core::ByteView InputCode::bytes() {
  end_run();
  return m_bytes;
}

void InputCode::clear() {
  m_bytes.clear();
  m_count = m_unchanged = 0;
  m_last = input_of({});
}

void InputCode::end_run() {
  if (m_unchanged == 0) return;
  core::put_varint(m_bytes, 0);
  core::put_varint(m_bytes, m_unchanged);
  m_unchanged = 0;
}

bool append_inputs(core::ByteView bytes, std::uint64_t count, std::vector<Input>& inputs) {
  const std::size_t before = inputs.size(), after = before + count;
  core::ByteReader from(bytes);
  Words words{};
  bool sound = true;
  while (sound && !from.at_end()) {
    const std::uint64_t mask = from.varint();
    const std::uint64_t repeats = mask ? 1 : from.varint();
    sound = from.sound() && !(mask >> kWords) && repeats > 0 && repeats <= after - inputs.size();
    for (std::size_t i = 0; sound && i < kWords; ++i)
      if (mask >> i & 1) words[i] ^= std::uint32_t(from.varint());
    sound = sound && from.sound();
    if (sound) inputs.insert(inputs.end(), repeats, input_of(words));
  }
  if (sound && inputs.size() == after) return true;
  inputs.resize(before);
  return false;
}

}  // namespace trocar::sim
