
#include <fmt/format.h>

#include <trocar/attempt/paths.hpp>
#include <trocar/attempt/session.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>
#include <trocar/reports/page_template.hpp>
#include <trocar/reports/report_data.hpp>
#include <trocar/reports/report_page.hpp>

namespace trocar::reports {

namespace fs = std::filesystem;

std::string report_html(const Report& report) { return fill(page_text("attempt.html"), page_data(report)); }

std::string write_report(const fs::path& folder, const Report& report) {
  attempt::make_folder(folder);
  Report here = report;
  for (ReportPicture& p : here.pictures) {
    const fs::path to = folder / p.file.filename();
    std::error_code error;
    if (!fs::equivalent(p.file, to, error)) fs::copy_file(p.file, to, fs::copy_options::overwrite_existing, error);
  }
  const fs::path path = folder / "index.html";
  write_page(path, report_html(here));
  return path.string();
}

std::string write_report(const fs::path& folder, const Json& result, const training::Store* store,
                         const attempt::Session* session) {
  training::Attempt attempt;
  const std::string uuid = text_in(part_of(result, "attempt"), "uuid");
  if (store && !uuid.empty())
    if (std::optional<training::Attempt> kept = store->find(uuid)) attempt = std::move(*kept);
  attempt.uuid = uuid;
  attempt.exercise = text_in(result, "exercise");
  attempt.input = text_in(result, "input");
  attempt.mode = training::mode_named(text_in(part_of(result, "attempt"), "mode")).value_or(attempt.mode);
  const std::string text = result.dump(-1, ' ', false, Json::error_handler_t::replace);
  attempt.state = training::state_in_result(text);
  if (attempt.program_version.empty()) attempt.program_version = TROCAR_VERSION;
  fill_from_result(text, attempt);
  if (session) {
    attempt.title = session->lesson().title;
    attempt.model_hash = session->lesson().model.hash;
    attempt.seed = session->lesson().seed;
    attempt.trace = session->trace_bytes();
  }
  Report report = gather(store, std::move(attempt));
  if (session)
    add_pictures(report, *session, folder);
  else if (!report.attempt.recording.empty())
    add_pictures(report, report.attempt.recording, folder);
  return write_report(folder, report);
}

}  // namespace trocar::reports
