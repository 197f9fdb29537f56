// A result as a page for people: one HTML file that needs nothing but its own folder.
#pragma once

#include <filesystem>
#include <string>

#include "json.hpp"

namespace trocar::app {

/// Writes FOLDER/index.html from a result (Session::result) and copies its pictures beside it; returns its path.
/// @throws core::EnvironmentLacks when it cannot be written
std::string write_report(const std::filesystem::path& folder, const Json& result);

/// The page itself. Pictures are named as in result["pictures"], relative to the page.
std::string report_html(const Json& result);

}  // namespace trocar::app
