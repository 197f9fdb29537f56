#include <algorithm>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include <trocar/attempt/verification/result_check.hpp>
#include <trocar/core/hash.hpp>
#include <trocar/core/printable.hpp>
#include <trocar/core/text.hpp>
#include <trocar/training/exercise/exercise_hash.hpp>
#include <trocar/training/store/attempt.hpp>
#include <trocar/training/store/json_fields.hpp>

namespace trocar::attempt {
namespace {

/// What of a result follows from the inputs.
constexpr const char* kJudged[] = {
    "passed", "assessment", "exercise_seconds", "ticks",           "metrics", "instruments", "grasps",
    "clips",  "cuts",       "clips_dropped",    "tissue_survived", "tears",   "flags",       "failure"};
/// Texts that are no words for people.
constexpr std::string_view kNames[] = {"code", "step", "side", "flags", "on"};

const Json& member(const Json& object, const std::string& key) {
  static const Json kNone;
  const auto at = object.find(key);
  return object.is_object() && at != object.end() ? *at : kNone;
}

bool equal(double a, double b) {
  constexpr double kRounding = 1e-6;
  return a == b || std::fabs(a - b) <= kRounding * std::max({1.0, std::fabs(a), std::fabs(b)});
}

std::string shown(const Json& value) {
  constexpr std::size_t kMost = 60;
  const std::string text = core::printable(value.dump(-1, ' ', true, Json::error_handler_t::replace));
  return text.size() <= kMost ? text : text.substr(0, kMost) + "...";
}

class Comparison {
 public:
  /// False at the first difference.
  bool agree(const Json& a, const Json& b, const std::string& path, std::string_view key) {
    if (a.is_number() && b.is_number()) return equal(a.get<double>(), b.get<double>()) || differ(a, b, path);
    if (a.is_string() && b.is_string())
      return std::find(std::begin(kNames), std::end(kNames), key) == std::end(kNames) || a == b || differ(a, b, path);
    if (a.type() != b.type() || a.size() != b.size()) return differ(a, b, path);
    if (a.is_object()) return members_agree(a, b, path);
    if (!a.is_array()) return a == b || differ(a, b, path);
    for (std::size_t i = 0; i < a.size(); ++i)
      if (!agree(a[i], b[i], path + "/" + std::to_string(i), key)) return false;
    return true;
  }
  const std::string& difference() const { return m_difference; }

 private:
  bool members_agree(const Json& a, const Json& b, const std::string& path) {
    for (const auto& [key, value] : a.items())
      if (!agree(value, member(b, key), path + "/" + key, key)) return false;
    return true;
  }
  bool differ(const Json& a, const Json& b, const std::string& path) {
    m_difference = fmt::format("{}: {} and {}", core::printable(path.substr(1)), shown(a), shown(b));
    return false;
  }
  std::string m_difference;
};

std::string difference_in_words(const sim::Recording& recording, const std::string& difference) {
  if (recording.header.program_version == TROCAR_VERSION)
    return tr("the result differs from what its inputs give, recorded value first: {}", difference);
  return tr(
      "the result differs from what its inputs give, recorded value first: {}. It was made with Trocar {}, which "
      "may have judged otherwise",
      difference, core::printable(recording.header.program_version));
}

}  // namespace

std::string first_difference(const Json& a, const Json& b) {
  Comparison both;
  for (const char* key : kJudged)
    if (!both.agree(member(a, key), member(b, key), std::string("/") + key, key)) break;
  return both.difference();
}

bool was_aborted(const sim::Recording& recording) {
  const Json result = training::json_in(recording.result_json);
  return result.is_object() && result.contains("interrupted");
}

ResultCheck check_result(const sim::Recording& recording, const Lesson& lesson, const Json& judged) {
  if (!recording.complete) return {"", tr("the recording has no result")};
  const std::string made_with = training::exercise_hash_in(recording.header.metadata_json);
  if (!lesson.exercise) return {"", tr("a scene without an exercise has no score")};
  if (made_with.empty()) return {"", tr("the recording does not say which exercise file it was made with")};
  if (made_with != core::hex(training::judgement_hash(*lesson.exercise)))
    return {"", tr("the exercise has changed since")};
  const Json recorded = training::json_in(recording.result_json);
  if (!recorded.is_object()) return {tr("the recording's result cannot be read"), ""};
  const std::string difference = first_difference(recorded, judged);
  return {difference.empty() ? "" : difference_in_words(recording, difference), ""};
}

}  // namespace trocar::attempt
