#include <cmath>

#include <trocar/attempt/team/message.hpp>
#include <trocar/sim/recording/input_code.hpp>

namespace trocar::attempt::message {
namespace {

using core::ByteReader;
using core::ByteString;

constexpr std::size_t kLongestText = 4096;

void put_inputs(ByteString& to, const std::vector<sim::Input>& inputs) {
  sim::InputCode code;
  for (const sim::Input& input : inputs) code.add(input);
  core::put_varint(to, inputs.size());
  const core::ByteView bytes = code.bytes();
  to.insert(to.end(), bytes.begin(), bytes.end());
}

/// They end the message.
bool get_inputs(ByteReader& from, std::vector<sim::Input>& inputs) {
  const std::uint64_t count = from.varint();
  return from.sound() && count <= kMostTicks && sim::append_inputs(from.rest(), count, inputs);
}

bool is_finite(const sim::Input& input) {
  const sim::ScopeInput& s = input.scope;
  bool finite = true;
  for (const float value : {s.yaw, s.pitch, s.roll, s.depth, s.post}) finite &= std::isfinite(value);
  for (const sim::ToolInput& t : input.tools)
    for (const float value : {t.yaw, t.pitch, t.roll, t.depth, t.handle}) finite &= std::isfinite(value);
  for (const sim::WristInput& w : input.wrists) finite &= std::isfinite(w.pitch) && std::isfinite(w.yaw);
  return finite;
}

struct Put {
  ByteString& to;
  void operator()(const Hello& m) const { text(m.role), text(m.version), core::put_varint(to, m.ticks); }
  void operator()(const Share& m) const {
    core::put_varint(to, m.number), core::put_varint(to, m.sent_us), put_inputs(to, {m.input});
  }
  void operator()(const Done& m) const {
    core::put_varint(to, m.ticks), core::put_varint(to, m.hashed), core::put(to, m.hash);
    core::put_varint(to, m.latency_us);
  }
  void operator()(const Attempt& m) const {
    text(m.exercise), text(m.version), core::put(to, m.seed), core::put(to, m.model_hash);
  }
  void operator()(const Ticks& m) const {
    core::put_varint(to, m.first), core::put_varint(to, m.number), core::put_varint(to, m.sent_us);
    put_inputs(to, m.inputs);
  }
  void operator()(const Waits& m) const { text(m.why); }
  void operator()(const End& m) const { text(m.why); }
  void text(const std::string& t) const { core::put_text(to, t.substr(0, kLongestText)); }
};

template <class M>
M got(ByteReader& from);
template <>
Hello got(ByteReader& from) {
  Hello m;
  m.role = from.text(), m.version = from.text(), m.ticks = from.varint();
  return m;
}
template <>
Done got(ByteReader& from) {
  Done m;
  m.ticks = from.varint(), m.hashed = from.varint(), m.hash = from.get<std::uint64_t>();
  m.latency_us = from.varint();
  return m;
}
template <>
Attempt got(ByteReader& from) {
  Attempt m;
  m.exercise = from.text(), m.version = from.text();
  m.seed = from.get<std::uint64_t>(), m.model_hash = from.get<std::uint64_t>();
  return m;
}

std::optional<Message> share(ByteReader& from) {
  Share m;
  std::vector<sim::Input> inputs;
  m.number = from.varint(), m.sent_us = from.varint();
  if (!get_inputs(from, inputs) || inputs.size() != 1 || !is_finite(inputs[0])) return std::nullopt;
  m.input = inputs[0];
  return m;
}

std::optional<Message> ticks(ByteReader& from) {
  Ticks m;
  m.first = from.varint(), m.number = from.varint(), m.sent_us = from.varint();
  if (!get_inputs(from, m.inputs)) return std::nullopt;
  for (const sim::Input& input : m.inputs)
    if (!is_finite(input)) return std::nullopt;
  return m;
}

template <class M>
std::optional<Message> whole(ByteReader& from, M message) {
  if (!from.sound() || !from.at_end()) return std::nullopt;
  return message;
}

}  // namespace

ByteString coded(const Message& message) {
  ByteString bytes{std::uint8_t(message.index())};
  std::visit(Put{bytes}, message);
  return bytes;
}

std::optional<Message> decoded(core::ByteView bytes) {
  ByteReader from(bytes);
  switch (from.get<std::uint8_t>()) {
    case 0:
      return from.sound() ? whole(from, got<Hello>(from)) : std::nullopt;
    case 1:
      return share(from);
    case 2:
      return whole(from, got<Done>(from));
    case 3:
      return whole(from, got<Attempt>(from));
    case 4:
      return ticks(from);
    case 5:
      return whole(from, Waits{from.text()});
    case 6:
      return whole(from, End{from.text()});
    default:
      return std::nullopt;
  }
}

}  // namespace trocar::attempt::message
