#include "guide/instrument_icon.hpp"

namespace trocar::app {
namespace {

/// Lines in a box of 1 x 1, the shaft comes in at the left.
class Pen {
 public:
  Pen(ImDrawList& draw, ImVec2 at, ImVec2 size, ImU32 colour)
      : m_draw(draw), m_at(at), m_size(size), m_colour(colour) {}
  ImVec2 at(float x, float y) const { return {m_at.x + x * m_size.x, m_at.y + y * m_size.y}; }
  void line(float x0, float y0, float x1, float y1, float thick = 0.12f) const {
    m_draw.AddLine(at(x0, y0), at(x1, y1), m_colour, thick * m_size.y);
  }
  void circle(float x, float y, float radius, float thick = 0.1f) const {
    m_draw.AddCircle(at(x, y), radius * m_size.y, m_colour, 0, thick * m_size.y);
  }
  void dot(float x, float y, float radius) const { m_draw.AddCircleFilled(at(x, y), radius * m_size.y, m_colour); }
  void box(float x0, float y0, float x1, float y1) const { m_draw.AddRectFilled(at(x0, y0), at(x1, y1), m_colour, 2); }

 private:
  ImDrawList& m_draw;
  ImVec2 m_at, m_size;
  ImU32 m_colour;
};

void jaws(const Pen& pen, float open, float thick) {
  pen.line(0.62f, 0.5f, 1, 0.5f - open, thick);
  pen.line(0.62f, 0.5f, 1, 0.5f + open, thick);
}

}  // namespace

void draw_instrument_icon(ImDrawList& draw, const interactions::Abilities& can, ImVec2 at, ImVec2 size, ImU32 colour) {
  const Pen pen(draw, at, size, colour);
  const bool wide = can.irrigate || can.bag;
  pen.line(0, 0.5f, 0.62f, 0.5f, wide ? 0.3f : 0.18f);
  if (can.cut) {
    jaws(pen, 0.3f, 0.08f);
    pen.dot(0.62f, 0.5f, 0.1f);
  } else if (can.set_clips) {
    jaws(pen, 0.24f, 0.14f);
    pen.line(0.84f, 0.36f, 0.84f, 0.64f, 0.08f);
  } else if (can.irrigate) {
    pen.dot(0.9f, 0.45f, 0.09f);
    pen.dot(0.9f, 0.75f, 0.06f);
  } else if (can.hook) {
    pen.line(0.62f, 0.5f, 0.95f, 0.5f, 0.08f);
    pen.line(0.95f, 0.5f, 0.95f, 0.78f, 0.08f);
  } else if (can.inject) {
    pen.line(0.62f, 0.5f, 1, 0.5f, 0.05f);
  } else if (can.bag) {
    pen.circle(0.84f, 0.5f, 0.34f);
  } else if (can.sling) {
    pen.line(0.62f, 0.5f, 0.7f, 0.5f, 0.06f);
    pen.circle(0.85f, 0.5f, 0.28f, 0.06f);
  } else if (can.grip) {
    jaws(pen, 0.26f, 0.13f);
  } else {
    pen.dot(0.68f, 0.5f, 0.12f);
  }
}

void draw_endoscope_icon(ImDrawList& draw, ImVec2 at, ImVec2 size, ImU32 colour) {
  const Pen pen(draw, at, size, colour);
  pen.box(0, 0.25f, 0.2f, 0.75f);
  pen.line(0.2f, 0.5f, 0.72f, 0.5f, 0.26f);
  pen.line(0.1f, 0.25f, 0.16f, 0, 0.1f);  // its light post
  pen.line(0.76f, 0.45f, 1, 0.15f, 0.06f);
  pen.line(0.76f, 0.55f, 1, 0.85f, 0.06f);
}

}  // namespace trocar::app
