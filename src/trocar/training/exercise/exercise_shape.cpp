// The tables that say which keys an exercise file has: the reader obeys them, and the published schema is written from
// them.
#include <iterator>

#include <trocar/scene/json/like.hpp>
#include <trocar/training/exercise/exercise.hpp>

namespace trocar::training {
namespace {

using scene::at_most;
using scene::needed;
using scene::Shape;
namespace keys = scene::keys;

const Shape& step_shape() {
  static const Shape shape{
      "step",
      "A part of the task: a state that lasts (when) or an act (on).",
      {needed(keys::name("step", "its name, unique in the exercise")),
       needed(keys::text("title", "text for the trainee; {n}, {name}, {title}")),
       keys::text("hint", "how to do it; {placeholders} for limits, {key:NAME} for controls"),
       keys::number("weight", 0, 100, "weight in the quality share of the score, default 1"),
       keys::name("for_each", "set: one step for each element"),
       keys::any("after", "\"previous\", one step or several: this step counts only after those are closed"),
       keys::any("needs", "one step or several: this step counts only after those are done"),
       keys::any("when", "condition: done when it has held for for_s"),
       keys::any("for_s", "how long it must hold: a number or a limit, default hold_s"),
       keys::any("on", "event: done when it happens"), keys::any("missed_when", "condition that closes it for good"),
       keys::any("missed_on", "event that closes it for good"),
       keys::any("undone_when", "condition that opens it again once it was done"),
       keys::flag("optional", "true: leaving it out costs nothing")}};
  return shape;
}

const Shape& error_shape() {
  static const Shape shape{
      "error",
      "An error and its penalty. An error with the code of a common rule makes that rule stricter.",
      {needed(keys::text("code", "the error's code")), keys::text("name", "two or three words"),
       keys::number("points", 0, 100, "points taken from the score"),
       keys::flag("fails", "true: the attempt fails whatever its score"),
       keys::text("meaning", "text for the trainee: what happened"),
       keys::text("hint", "text for the trainee: how to avoid it"),
       keys::text("source", "of the penalty: a publication, or \"our estimate\""),
       keys::name("for_each", "set: one error for each element"), keys::any("on", "event: the error occurs with it"),
       keys::any("when",
                 "condition: the error occurs after it has held for for_s, and again after it has ended in between"),
       keys::any("for_s", "how long the condition must hold: a number or a limit, default 0"),
       keys::choice("once_per", {"excursion", "attempt"},
                    "attempt: at most once; default excursion: once per excursion"),
       keys::text("detail", "detail in the result; {on} is the body of the event"),
       keys::text("at", "mark of the scene where the error of a condition is shown"),
       keys::texts("implies", "codes of errors that always occur with it"),
       keys::texts("may", "codes of errors that can occur with it"),
       keys::texts("leaves", "steps that the event does not complete"), keys::texts("misses", "steps that it closes")}};
  return shape;
}

const Shape& detail_shape() {
  static const Shape shape{
      "detail",
      "A fact in the result, besides clips and cuts. Its arguments are keys of the same object.",
      {needed(keys::name("detail", "its name in results, with the fact's unit")),
       needed(keys::any("value", "a fact with its arguments")), keys::name("for_each", "set: one for each element"),
       keys::choice("keep", {"last", "most", "range"}, "default last"),
       keys::any("while", "condition: the fact is evaluated only while it holds")}};
  return shape;
}

const Shape& later_shape() {
  static const Shape shape{"later error",
                           "An error whose detection is not implemented.",
                           {needed(keys::text("code", "its code")), needed(keys::text("name", "two or three words")),
                            needed(keys::text("needs", "the missing feature of the simulation"))}};
  return shape;
}

scene::Key seed_key() {
  scene::Key key = keys::integer("seed", 0, 0, "of the anatomy");
  key.high = double(kLargestRehearsedSeed);
  return key;
}

const Shape& rehearsed_shape() {
  static const Shape shape{
      "rehearsed anatomy",
      "Choices with which the demonstration succeeds with one anatomy, as printed by `trocar rehearse`.",
      {needed(seed_key()),
       needed(keys::any("choices", "list of [decision, perturbation]; other decisions follow the plan as written"))}};
  return shape;
}

const Shape& score_shape() {
  static const Shape shape{
      "score",
      "Shares of the score; unknown parts are left out and the rest renormalised.",
      {needed(keys::number("quality", 0, 100, "points for the weighted share of completed steps")),
       needed(keys::number("time", 0, 100, "points for time, from the longest to the expert time")),
       needed(keys::number("motion", 0, 100, "points for motion against a reference group, once one exists")),
       needed(keys::text("source", "source of the shares"))}};
  return shape;
}

std::vector<std::string> group_names() { return {std::begin(kGroups), std::end(kGroups)}; }

}  // namespace

const Shape& exercise_shape() {
  static const Shape shape{
      "exercise",
      "A task in a scene and its evaluation: docs/reference/exercise_format.md.",
      {keys::text("$schema", "where editors find this kind of file's schema"),
       keys::format(3),
       needed(keys::name("name", "its name on the command line")),
       keys::text(scene::kLike, "exercise file that supplies the missing keys, relative to this file"),
       needed(keys::text("title", "for people")),
       keys::text("summary", "two or three sentences for the list of exercises"),
       keys::integer("order", 0, 1000, "position in lists: lower numbers come first; default 1000"),
       keys::choice("group", group_names(), "group on the start screen; default: other exercises"),
       keys::integer("level", 1, kMostLevel, "1 beginner, 2 intermediate, 3 advanced; default 1"),
       needed(keys::text("scene", "path of the scene file, relative to this file")),
       at_most(kMaxIncludes, keys::texts("includes", "files of common rules, relative to this file")),
       keys::any("limits", "limits by name: {\"value\": number or [from, to], \"source\": ...}"),
       keys::any("sets", "sets of repeated elements, by name: a list of elements, or a pattern"),
       needed(at_most(kMaxSteps, keys::objects("steps", step_shape, 1, "steps in the order of the display"))),
       at_most(kMaxErrors, keys::objects("errors", error_shape, 0, "in the order in which they are reported")),
       keys::objects("details", detail_shape, 0, "facts in the result"),
       keys::objects("later", later_shape, 0, "errors whose detection is not implemented"),
       keys::any("demonstration", "its demonstration: a plan of hand skills"),
       keys::objects("rehearsed", rehearsed_shape, 0,
                     "recorded choices of its demonstration by anatomy; not inherited"),
       needed(keys::object("score", score_shape, "shares of the score")),
       needed(keys::number("hold_s", 0, 10, "time that a step's condition must hold")),
       needed(keys::number("expert_s", 1, 36000, "time for all time points")),
       needed(keys::number("longest_s", 1, 36000, "time for no time points")),
       needed(keys::number("pass_mark", 0, 100, "score needed")),
       keys::texts("sources", "publications cited here")}};
  return shape;
}

const Shape& common_rules_shape() {
  static const Shape shape{
      "common rules",
      "Common limits, steps and errors that exercises include. An exercise may make errors and limits stricter.",
      {keys::text("$schema", "where editors find this kind of file's schema"), keys::format(3),
       needed(keys::text("title", "for people")),
       keys::any("limits", "as in an exercise, with the direction that makes each stricter"),
       keys::any("sets", "as in an exercise; an exercise may replace them"),
       at_most(kMaxSteps, keys::objects("steps", step_shape, 0,
                                        "as in an exercise, placed before the exercise's own; default none")),
       at_most(kMaxErrors, keys::objects("errors", error_shape, 0, "as in an exercise, default none")),
       keys::texts("sources", "publications cited here")}};
  return shape;
}

}  // namespace trocar::training
