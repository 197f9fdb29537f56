// Results that wait in files for their store.
#include <trocar/training/store/attempt.hpp>

#include "targets.hpp"

namespace trocar::fuzz {

void waiting_file(Bytes bytes) {
  const std::optional<training::Attempt> read = training::attempt_from_json(text_of(bytes));
  if (!read) return;
  training::Attempt a = *read;
  require(training::is_uuid(a.uuid), "its uuid names files and leads nowhere else");
  require(training::clean_name(a.trainee) == a.trainee, "a name is clean");
  const std::optional<training::Attempt> again = training::attempt_from_json(training::to_json(a));
  require(
      again && again->uuid == a.uuid && again->trainee == a.trainee && (a.result.empty() || again->result == a.result),
      "what was read can be written and read");
  const bool has_result = !a.result.empty();
  training::mark_unverified(a);
  require(training::is_unverified(a) == has_result, "a result from a recording is marked");
  training::fill_from_result(a.result, a);
  require(!has_result || !a.score || a.mode != training::AttemptMode::familiarisation,
          "a familiarisation has no score");
}

std::vector<Seed> waiting_seeds() {
  training::Attempt a;
  a.number = 3;
  a.uuid = "0123456789abcdef-0123";
  a.trainee = "Ada";
  a.exercise = "basics/camera-0";
  a.started = "2026-03-01T10:00:00Z";
  a.state = training::AttemptState::finished;
  a.recording = "/data/recordings/a.rec";
  a.store = "/data";
  training::Attempt bare = a;
  training::fill_from_result(
      R"({"from_recording":false,"passed":true,"ticks":7,"assessment":{"score":{"total":87.5}}})", a);
  return {{"whole", bytes_of(training::to_json(a))}, {"bare", bytes_of(training::to_json(bare))}};
}

}  // namespace trocar::fuzz
