// Another anatomy that some patients have, as a scene declares it: which one a seed draws, and what a scene becomes
// with it. A variant brings bodies, vessels and marks; one that is called as something of the scene takes its place,
// the others are added.
//
//   if (const auto* v = drawn_variant(*d.variation, seed)) put_in(d, *v);
#pragma once

#include <cstdint>
#include <string>

#include <trocar/scene/description/description.hpp>

namespace trocar::scene {

/// Null: there is none of that name.
const VariationSetting::Variant* find_variant(const VariationSetting& variation, const std::string& name);

/// The one that a patient of this seed has, each as often as its share says; null: the common anatomy, as always for
/// seed 0. Of numbers of its own: what else the seed draws does not depend on it.
const VariationSetting::Variant* drawn_variant(const VariationSetting& variation, std::uint64_t seed);

/// The scene gets this anatomy. What it brings of its own stands at the end of each list.
void put_in(Description& description, const VariationSetting::Variant& variant);

/// What an organ's or a vessel's file fills, and marks: all of it changes places.
void swap_bodies(Description& a, Description& b);

}  // namespace trocar::scene
