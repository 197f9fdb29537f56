// How finely things are drawn, by how far off they are.
#include <algorithm>

#include <fmt/format.h>

#include <trocar/scene/files/reader_parts.hpp>

namespace trocar::scene {
namespace {

constexpr std::size_t kMostLevels = 8;

DetailSetting::Level level(const JsonObject& o) {
  return {from_mm(o.number("from_mm", 1)), from_mm(o.number("error_mm", 1)), o.integer("surface", 2)};
}

/// From one level to the next things are farther away, and not finer.
void check_order(const JsonObject& o, const DetailSetting::Level& before, const DetailSetting::Level& now) {
  if (o.has("from_mm") && !(now.from > before.from))
    o.fault("from_mm",
            fmt::format("expected more than the level before, {} mm, got {}", 1000 * before.from, o.number("from_mm")));
  if (o.has("error_mm") && now.error < before.error)
    o.fault("error_mm", fmt::format("expected no less than the level before, {} mm, got {}", 1000 * before.error,
                                    o.number("error_mm")));
  if (now.surface > before.surface)
    o.fault("surface", fmt::format("expected no more than the level before, {}, got {}", before.surface, now.surface));
}

}  // namespace

void Reading::detail(const JsonObject& o) {
  DetailSetting d;
  d.at = o.at();
  d.of = o.texts("of");
  if (o.has("of") && d.of.empty()) o.fault("of", "expected the name of something, got none");
  for (std::size_t i = 0; i < d.of.size(); ++i) {
    m_references.push_back({Reference::To::drawn, d.of[i], o.at("of", i)});
    const auto named = [&](const DetailSetting& other) {
      return std::find(other.of.begin(), other.of.end(), d.of[i]) != other.of.end();
    };
    const bool again =
        std::find(d.of.begin(), d.of.begin() + std::ptrdiff_t(i), d.of[i]) < d.of.begin() + std::ptrdiff_t(i);
    if (again || std::any_of(description.detail.begin(), description.detail.end(), named))
      o.fault(o.at("of", i), fmt::format("expected everything once, got \"{}\" again", d.of[i]));
  }
  const std::vector<JsonObject> levels = o.objects("levels");
  if (levels.size() > kMostLevels)
    return o.fault("levels", fmt::format("expected at most {} levels, got {}", kMostLevels, levels.size()));
  for (const JsonObject& l : levels) {
    const DetailSetting::Level now = level(l);
    if (!d.levels.empty()) check_order(l, d.levels.back(), now);
    d.levels.push_back(now);
  }
  description.detail.push_back(std::move(d));
}

}  // namespace trocar::scene
