#include "commands/report/report_trace.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>

#include <fmt/format.h>

#include <trocar/attempt/interrupt.hpp>
#include <trocar/attempt/paths.hpp>
#include <trocar/attempt/progress.hpp>
#include <trocar/attempt/session.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/hash.hpp>
#include <trocar/core/text.hpp>
#include <trocar/sim/recording/recording.hpp>

namespace trocar::app {

namespace fs = std::filesystem;

training::Trace trace_of_recording(const fs::path& file) {
  const sim::Recording recording = sim::read_recording(file);
  const std::unique_ptr<attempt::Lesson> lesson =
      attempt::load_lesson(recording.header.exercise, recording.header.seed);
  if (lesson->model.hash != recording.header.model_hash)
    throw core::BadInput(
        {{{file.string(), 0, 0},
          tr("expected a recording of this version of physics and scene, got one of program {}: its motion cannot be "
             "simulated again",
             recording.header.program_version)}});
  attempt::catch_interrupts();
  attempt::Session session(*lesson);
  attempt::Progress progress(0, recording.inputs.size());
  for (std::size_t tick = 0; tick < recording.inputs.size() && session.broken().empty(); ++tick) {
    if (attempt::interrupted()) throw core::EnvironmentLacks(tr("Interrupted: no motion was written."));
    session.advance(recording.inputs[tick]);
    progress.at(tick);
  }
  return session.trace();
}

training::TraceOrigin origin_of(const training::Attempt& attempt, bool names) {
  const std::string alias =
      "person-" + core::hex(core::hash_bytes(attempt.trainee.data(), attempt.trainee.size())).substr(0, 8);
  const std::string trial = attempt.number > 0 ? fmt::format("{}", attempt.number) : attempt.uuid;
  return {names ? attempt.trainee : alias, trial};
}

int write_traces(const training::Store& store, const std::string& trainee, bool names, const fs::path& folder) {
  attempt::make_folder(folder);
  int written = 0;
  for (const training::Attempt& listed : store.list({.trainee = trainee})) {
    const std::optional<training::Attempt> a = store.find(listed.uuid);
    if (!a || a->trace.empty()) continue;
    const training::Trace trace = training::trace_from_bytes(a->trace, listed.uuid);
    write_text(folder / fmt::format("{:05}.csv", a->number), to_csv(trace, origin_of(*a, names)));
    ++written;
  }
  return written;
}

void write_text(const fs::path& path, const std::string& text) {
  std::ofstream out(path, std::ios::binary);
  out << text;
  if (!out.flush())
    throw core::EnvironmentLacks(tr("cannot write {}: {}", path.string(), std::strerror(errno ? errno : ENOSPC)));
}

}  // namespace trocar::app
