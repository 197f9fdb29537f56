// What a result and a recording know of the attempt that they come from.
#include <fmt/format.h>

#include <trocar/core/hash.hpp>
#include <trocar/core/json.hpp>
#include <trocar/sim/model/model.hpp>
#include <trocar/sim/recording/recording.hpp>
#include <trocar/training/store/json_fields.hpp>
#include <trocar/training/store/store_parts.hpp>

namespace trocar::training {

namespace fs = std::filesystem;

void fill_from_result(const std::string& result, Attempt& a) {
  const Json in = json_in(result);
  if (!in.is_object()) return;
  a.result = result;
  if (in.contains("passed") && in["passed"].is_boolean()) a.passed = in["passed"].get<bool>();
  if (in.contains("ticks") && in["ticks"].is_number_unsigned()) a.ticks = in["ticks"].get<std::uint64_t>();
  a.seconds = double(a.ticks) * sim::kTick;
  const Json::json_pointer total("/assessment/score/total");
  if (in.contains(total) && in[total].is_number()) a.score = in[total].get<double>();
  if (a.mode == AttemptMode::familiarisation) a.score.reset(), a.passed.reset();
}

AttemptState state_in_result(const std::string& result) {
  const Json in = json_in(result);
  if (!in.is_object()) return AttemptState::finished;
  if (in.contains("failure")) return AttemptState::not_assessed;
  return in.contains("interrupted") ? AttemptState::aborted : AttemptState::finished;
}

namespace {

constexpr const char* kFromRecording = "from_recording";

}  // namespace

void mark_unverified(Attempt& a) {
  const Json in = json_in(a.result);
  if (!in.is_object()) return;
  Json out{{kFromRecording, true}};  // first, so that is_unverified() finds it
  for (const auto& [key, value] : in.items())
    if (key != kFromRecording) out[key] = value;
  a.result = out.dump(-1, ' ', false, Json::error_handler_t::replace);
}

bool is_unverified(const Attempt& a) { return a.result.rfind(fmt::format("{{\"{}\":true", kFromRecording), 0) == 0; }

AttemptMode mode_in_header(const std::string& metadata_json) {
  const Json note = json_in(metadata_json);
  if (!note.is_object()) return AttemptMode::assessed;
  return mode_named(text_in(note, "mode")).value_or(AttemptMode::assessed);
}

std::string exercise_hash_in(const std::string& metadata_json) {
  const Json note = json_in(metadata_json);
  return note.is_object() ? text_in(note, kExerciseHash) : std::string();
}

bool fill_from_recording(const fs::path& file, Attempt& a) {
  sim::Recording r;
  try {
    r = sim::read_recording(file);
  } catch (const std::exception&) {
    return false;
  }
  const Json note = json_in(r.header.metadata_json);
  a.recording = fs::absolute(file).string();
  a.exercise = bounded(r.header.exercise);
  a.seed = r.header.seed;
  a.program_version = bounded(r.header.program_version);
  a.model_hash = r.header.model_hash;
  a.ticks = r.inputs.size();
  a.seconds = double(a.ticks) * sim::kTick;
  if (note.is_object()) {
    if (a.uuid.empty() && is_uuid(text_in(note, "uuid"))) a.uuid = text_in(note, "uuid");
    const std::uint64_t number =
        note.contains("number") && note["number"].is_number_unsigned() ? note["number"].get<std::uint64_t>() : 0;
    if (a.number == 0 && number < kLargestNumber) a.number = std::int64_t(number);
    if (a.trainee.empty()) a.trainee = clean_name(text_in(note, "trainee"));
    if (a.title.empty()) a.title = bounded(text_in(note, "title"));
    if (a.input.empty()) a.input = bounded(text_in(note, "input"));
    if (a.started.empty()) a.started = bounded(text_in(note, "started"));
    a.mode = mode_named(text_in(note, "mode")).value_or(a.mode);
  }
  if (a.uuid.empty())  // made before attempts had one: the same file is the same attempt
    a.uuid = fmt::format("recording-{:016x}",
                         core::hash_bytes(r.header.metadata_json.data(), r.header.metadata_json.size(), a.model_hash));
  a.state = AttemptState::interrupted;
  if (r.complete) {
    fill_from_result(r.result_json, a);
    a.state = state_in_result(r.result_json);
    const Json result = json_in(r.result_json);
    if (result.is_object() && a.ended.empty()) a.ended = bounded(text_in(result, "ended"));
  }
  return true;
}

}  // namespace trocar::training
