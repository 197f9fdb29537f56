#include "report_opener.hpp"

#include <exception>

#include <trocar/core/error.hpp>

#include "paths.hpp"
#include "report_page.hpp"
#include "ui.hpp"

namespace trocar::app {
namespace {

/// @throws core::EnvironmentLacks
std::string make_page(const training::Store& store, const std::string& name) {
  const std::optional<training::Attempt> attempt = store.find(name);
  if (!attempt) throw core::EnvironmentLacks("the store does not know this attempt");
  Report report = gather(&store, *attempt);
  const std::filesystem::path folder = store.folder() / "reports" / attempt->uuid;
  make_folder(folder);
  if (!attempt->recording.empty()) add_pictures(report, attempt->recording, folder);
  return write_report(folder, report);
}

}  // namespace

void ReportOpener::open(const training::Store* store, const std::string& attempt) {
  if (m_page.valid() || !store) return;
  m_say = "making the report ...";
  m_page = std::async(std::launch::async, [store, attempt] { return make_page(*store, attempt); });
}

std::string ReportOpener::poll() {
  if (!m_page.valid() || m_page.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return {};
  try {
    const std::string page = m_page.get();
    m_say = (ui::open_in_browser(page) ? "opened in the browser: " : "the report is in ") + page;
    return page;
  } catch (const std::exception& fault) {
    m_say = std::string("no report: ") + fault.what();
    return {};
  }
}

}  // namespace trocar::app
