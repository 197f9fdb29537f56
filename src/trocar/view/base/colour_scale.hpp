// From a number to a colour, for false-colour pictures. Two scales, made of colours that stay apart with every kind of
// colour vision [Okabe & Ito 2008]:
//   diverging   blue, sky, near white, orange, vermilion: which side by hue (blue against yellow-red is what people
//               with red-green blindness see best), how far by lightness, which falls alike to both ends
//   sequential  dark violet, blue, grey, ochre, light yellow: lightness rises all the way, so a grey copy reads alike
//
//   const Colour c = colour_on(Scale::diverging, strain / range);   // -1 .. 1
//   mesh.paint[v] = paint_shown_as(c);                              // lit fully, the picture shows just that colour
#pragma once

#include <trocar/render/frame/frame.hpp>

namespace trocar::view {

/// As a screen shows it, sRGB, 0..1.
struct Colour {
  float r = 0, g = 0, b = 0;
};

enum class Scale {
  diverging,   ///< -1 .. 1, 0 in its middle
  sequential,  ///< 0 .. 1
};
/// Beyond its ends a scale continues with their colours; what is not a number gets the first one.
Colour colour_on(Scale scale, double value);

/// CIE lightness, 0 black .. 100 white.
double lightness_of(Colour c);

/// Paint of unlit or false-coloured meshes that the camera of analysis_look() shows as `c`, where light_for_analysis()
/// falls on it fully.
render::Paint paint_shown_as(Colour c);

/// A camera without lens, exposure memory and noise, and a lamp beside it that is as bright everywhere: colours say
/// what the legend says.
render::EndoscopeLook analysis_look();
render::Light light_for_analysis();

}  // namespace trocar::view
