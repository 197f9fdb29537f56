#include <algorithm>
#include <utility>
#include <vector>

#include <trocar/core/random.hpp>
#include <trocar/scene/description/variant.hpp>

namespace trocar::scene {
namespace {

using Variant = VariationSetting::Variant;

/// Makes what a variant draws independent of all that a seed draws else. Of some numbers the one with which the seeds 1
/// to 9, which documents and tests name, have the common anatomy of the cholecystectomy scenes.
constexpr std::uint64_t kOwnNumbers = 0xca10'00e0ull;

template <class T>
void put_each(std::vector<T>& scene, const std::vector<T>& brought) {
  for (const T& one : brought) {
    const auto same = [&one](const T& other) { return other.name == one.name; };
    const auto old = std::find_if(scene.begin(), scene.end(), same);
    if (old == scene.end())
      scene.push_back(one);
    else
      *old = one;
  }
}

void put_fat(Description& d, const Variant::MoreFat& more) {
  for (FatSetting& fat : settings_of(FatScene{}, d.objects)) {
    if (fat.name != more.of) continue;
    fat.fills.insert(fat.fills.end(), more.fills.begin(), more.fills.end());
    fat.on.insert(fat.on.end(), more.on.begin(), more.on.end());
  }
}

void put_hold(Description& d, const Variant::Hold& hold) {
  for (Pouch& pouch : d.pouches) {
    if (pouch.name != hold.pouch) continue;
    if (length(hold.instead) > 0 && !pouch.held.empty())
      pouch.held.erase(std::min_element(pouch.held.begin(), pouch.held.end(), [&](const Anchor& a, const Anchor& b) {
        return length(a.centre - hold.instead) < length(b.centre - hold.instead);
      }));
    pouch.held.push_back({hold.centre, hold.radius, 0, hold.at});
    if (std::find(pouch.held_on.begin(), pouch.held_on.end(), hold.on) == pouch.held_on.end())
      pouch.held_on.push_back(hold.on);
  }
}

}  // namespace

const Variant* find_variant(const VariationSetting& variation, const std::string& name) {
  for (const Variant& v : variation.variants)
    if (v.name == name) return &v;
  return nullptr;
}

const Variant* drawn_variant(const VariationSetting& variation, std::uint64_t seed) {
  if (seed == 0) return nullptr;
  double left = core::Random(seed ^ kOwnNumbers).uniform();
  for (const Variant& v : variation.variants) {
    if (left < v.share) return &v;
    left -= v.share;
  }
  return nullptr;
}

void put_in(Description& d, const Variant& variant) {
  if (variant.brings) {
    const Description& brings = *variant.brings;
    put_each(d.solids, brings.solids), put_each(d.strands, brings.strands), put_each(d.walls, brings.walls);
    put_each(d.sheets, brings.sheets), put_each(d.membranes, brings.membranes), put_each(d.pouches, brings.pouches);
    put_each(d.vessels, brings.vessels), put_each(d.marks, brings.marks);
  }
  for (const Variant::Hold& hold : variant.holds) put_hold(d, hold);
  for (const Variant::MoreFat& more : variant.fat) put_fat(d, more);
}

void swap_bodies(Description& a, Description& b) {
  std::swap(a.solids, b.solids), std::swap(a.strands, b.strands), std::swap(a.walls, b.walls);
  std::swap(a.sheets, b.sheets), std::swap(a.membranes, b.membranes), std::swap(a.pouches, b.pouches);
  std::swap(a.vessels, b.vessels), std::swap(a.marks, b.marks);
}

}  // namespace trocar::scene
