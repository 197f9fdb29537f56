#include <algorithm>
#include <array>
#include <cmath>

#include <unistd.h>

#include <trocar/core/json.hpp>
#include <trocar/training/store/attempt.hpp>
#include <trocar/training/store/json_fields.hpp>

namespace trocar::training {
namespace {

constexpr const char* kModes[] = {"assessed", "familiarisation", "demonstration", "free practice"};
constexpr const char* kStates[] = {"running", "finished", "aborted", "interrupted", "not assessed"};

template <class Enum, std::size_t N>
std::optional<Enum> named(const char* const (&names)[N], const std::string& name) {
  for (std::size_t i = 0; i < N; ++i)
    if (name == names[i]) return Enum(i);
  return std::nullopt;
}

/// Length of the UTF-8 character at text[at]; 0 where there is none.
std::size_t character_at(const std::string& text, std::size_t at) {
  const auto lead = static_cast<unsigned char>(text[at]);
  const std::size_t size = lead < 0x80 ? 1 : lead >> 5 == 6 ? 2 : lead >> 4 == 14 ? 3 : lead >> 3 == 30 ? 4 : 0;
  if (size == 0 || at + size > text.size()) return 0;
  for (std::size_t i = 1; i < size; ++i)
    if ((static_cast<unsigned char>(text[at + i]) & 0xc0) != 0x80) return 0;
  return size;
}

std::uint64_t whole_of(const Json& object, const char* key) {
  const auto at = object.find(key);
  return at != object.end() && at->is_number_integer() ? at->get<std::uint64_t>() : 0;
}

}  // namespace

const char* name_of(AttemptMode mode) { return kModes[size_t(mode)]; }
const char* name_of(AttemptState state) { return kStates[size_t(state)]; }
std::optional<AttemptMode> mode_named(const std::string& name) { return named<AttemptMode>(kModes, name); }
std::optional<AttemptState> state_named(const std::string& name) { return named<AttemptState>(kStates, name); }

std::string clean_name(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t size = character_at(text, i);
    const auto byte = static_cast<unsigned char>(text[i]);
    const bool control = byte < 0x20 || byte == 0x7f || (byte == 0xc2 && size == 2 && text[i + 1] < char(0xa0));
    if (out.size() + size > kLongestName) break;
    if (size > 0 && !control)
      out.append(text, i, size);
    else if (control && !out.empty() && out.back() != ' ')
      out += ' ';
    i += size > 0 ? size : 1;
  }
  while (!out.empty() && out.back() == ' ') out.pop_back();
  out.erase(0, out.find_first_not_of(' ') == std::string::npos ? out.size() : out.find_first_not_of(' '));
  return out;
}

bool is_uuid(const std::string& text) {
  const auto plain = [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || c == '-'; };
  return text.size() >= 16 && text.size() <= 64 && std::all_of(text.begin(), text.end(), plain);
}

std::string new_uuid() {
  std::array<unsigned char, 16> bytes{};
  if (getentropy(bytes.data(), bytes.size()) != 0) {  // no source of chance: the process and its stack have to do
    const auto here = reinterpret_cast<std::uintptr_t>(&bytes);
    for (std::size_t i = 0; i < bytes.size(); ++i)
      bytes[i] = static_cast<unsigned char>((std::uint64_t(getpid()) * 2654435761u + here) >> (i % 8 * 8));
  }
  bytes[6] = static_cast<unsigned char>((bytes[6] & 0x0f) | 0x40);  // version 4
  bytes[8] = static_cast<unsigned char>((bytes[8] & 0x3f) | 0x80);
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    if (i == 4 || i == 6 || i == 8 || i == 10) out += '-';
    out += "0123456789abcdef"[bytes[i] >> 4];
    out += "0123456789abcdef"[bytes[i] & 15];
  }
  return out;
}

std::string to_json(const Attempt& a) {
  Json out{{"trocar_attempt", 1},        {"number", a.number},       {"uuid", a.uuid},
           {"trainee", a.trainee},       {"exercise", a.exercise},   {"title", a.title},
           {"mode", name_of(a.mode)},    {"seed", a.seed},           {"input", a.input},
           {"started", a.started},       {"ended", a.ended},         {"state", name_of(a.state)},
           {"score", nullptr},           {"passed", nullptr},        {"seconds", a.seconds},
           {"ticks", a.ticks},           {"recording", a.recording}, {"program_version", a.program_version},
           {"model_hash", a.model_hash}, {"store", a.store}};
  if (a.score) out["score"] = *a.score;
  if (a.passed) out["passed"] = *a.passed;
  Json result = json_in(a.result);
  out["result"] = result.is_object() ? std::move(result) : Json::object();
  return out.dump(1, ' ', false, Json::error_handler_t::replace);
}

std::optional<Attempt> attempt_from_json(const std::string& text) {
  const Json in = json_in(text);
  if (!in.is_object() || whole_of(in, "trocar_attempt") != 1 || !is_uuid(text_in(in, "uuid"))) return std::nullopt;
  Attempt a;
  a.number = std::int64_t(whole_of(in, "number"));
  a.uuid = text_in(in, "uuid");
  a.trainee = clean_name(text_in(in, "trainee"));
  a.exercise = text_in(in, "exercise");
  a.title = text_in(in, "title");
  a.mode = mode_named(text_in(in, "mode")).value_or(AttemptMode::assessed);
  a.seed = whole_of(in, "seed");
  a.input = text_in(in, "input");
  a.started = text_in(in, "started");
  a.ended = text_in(in, "ended");
  a.state = state_named(text_in(in, "state")).value_or(AttemptState::interrupted);
  if (in.contains("score") && in["score"].is_number()) a.score = in["score"].get<double>();
  if (in.contains("passed") && in["passed"].is_boolean()) a.passed = in["passed"].get<bool>();
  if (in.contains("seconds") && in["seconds"].is_number()) a.seconds = in["seconds"].get<double>();
  a.ticks = whole_of(in, "ticks");
  a.recording = text_in(in, "recording");
  a.program_version = text_in(in, "program_version");
  a.model_hash = whole_of(in, "model_hash");
  a.store = text_in(in, "store");
  if (in.contains("result") && in["result"].is_object())
    a.result = in["result"].dump(-1, ' ', false, Json::error_handler_t::replace);
  return a;
}

}  // namespace trocar::training
