// Everything that is known of an attempt, gathered for its report: its result, its motion, the attempts before it, and
// how the demonstration did the same.
//
//   Report report = gather(store, attempt);                 // attempt: with result and trace, Store::find gives it
//   add_pictures(report, recording, folder / "pictures");   // takes seconds; needs OpenGL, says so if there is none
//   write_report(folder, report);                           // FOLDER/index.html
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <trocar/core/json.hpp>
#include <trocar/training/metrics/trace.hpp>
#include <trocar/training/store/json_fields.hpp>
#include <trocar/training/store/store.hpp>

namespace trocar::attempt {
class Session;
}
namespace trocar::reports {

struct ReportPicture {
  std::filesystem::path file;
  std::string shows;
  double seconds = 0;  ///< since the start
};

struct Report {
  training::Attempt attempt;
  Json result = Json::object();
  std::optional<training::Trace> trace;
  std::vector<training::Attempt> history;     ///< the same trainee and exercise, ended, oldest first, with this one
  std::optional<training::Attempt> scripted;  ///< the demonstration on the same anatomy
  std::vector<ReportPicture> pictures;
  std::string pictures_note;  ///< why there are none
  bool names = false;         ///< may the page say whose attempt it is?
};

/// @param store  may be null: then there is only the attempt itself
Report gather(const training::Store* store, training::Attempt attempt);

/// Draws up to kMostPictures key moments (steps done, errors, clips, cuts, grips) from the recording's keyframes into
/// `folder`. On a thread of its own, so that a window's context stays what it is.
void add_pictures(Report& report, const std::filesystem::path& recording, const std::filesystem::path& folder);
/// The same from what a session has kept, for attempts without a recording.
void add_pictures(Report& report, const attempt::Session& session, const std::filesystem::path& folder);
inline constexpr std::size_t kMostPictures = 16;

/// The demonstration of the exercise runs now, headless, and the store keeps it. Takes minutes.
/// @throws core::BadInput where nobody knows how to do it
training::Attempt demonstrate(training::Store& store, const std::string& exercise, std::uint64_t seed);

/// A number in the result, by a path like "/metrics/both/path_m"; nothing where there is none.
std::optional<double> number_in(const Json& result, const std::string& pointer);

using training::text_in;

}  // namespace trocar::reports
