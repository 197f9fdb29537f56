// A report as a page for people: one folder that opens without a network, in any browser, a text browser too.
#pragma once

#include <filesystem>
#include <string>

#include <trocar/reports/report.hpp>

namespace trocar::reports {

/// Writes FOLDER/index.html; pictures that lie elsewhere are copied beside it. Returns the page's path.
/// @throws core::EnvironmentLacks when it cannot be written
std::string write_report(const std::filesystem::path& folder, const Report& report);

/// From a result alone (Session::result), its attempt's number in "attempt"; with a store also what came before.
std::string write_report(const std::filesystem::path& folder, const Json& result,
                         const training::Store* store = nullptr, const attempt::Session* session = nullptr);

/// The page itself; pictures are named relative to it.
std::string report_html(const Report& report);

}  // namespace trocar::reports
