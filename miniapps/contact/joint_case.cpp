#include "contact/joint_case.hpp"

#include "common/miniapp.hpp"

#include <algorithm>
#include <cattaneo/exchange/read_stiffness.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/words.hpp>
#include <cctype>
#include <cmath>
#include <filesystem>

namespace miniapp
{

using namespace cattaneo;
using nlohmann::ordered_json;

namespace
{

const std::vector<std::string> analyses = {"plane strain", "plane stress", "axisymmetric",
                                           "space"};
const std::vector<std::string> geometries = {"smooth", "as meshed"};
const std::vector<std::string> slaves = {"coarser", "finer", "first", "second"};

/// A JSON value with its place in the case file, for errors.
class Key
{
public:
   Key(const ordered_json &value, std::string path) : value_(value), path_(std::move(path)) {}

   std::string called() const { return "key '" + path_ + "'"; }
   const std::string &path() const { return path_; }
   const ordered_json &value() const { return value_; }
   [[noreturn]] void refuse(const std::string &allowed) const
   {
      // Nested values are not shown, because they may be too deep to be written.
      throw InputError(called() + " is " +
                       (value_.empty() && value_.is_structured() ? std::string("empty")
                        : value_.is_array()                      ? "a list"
                        : value_.is_object()                     ? "an object"
                                                                 : value_.dump()) +
                       ", must be " + allowed);
   }
   bool has(const std::string &name) const { return value_.contains(name); }
   Key operator[](const std::string &name) const
   {
      require(has(name), called(), " has no '", name, "', must have one");
      return {value_.at(name), path_ + "." + name};
   }
   /// InputError unless it is an object without other keys.
   void must_be_of(const std::vector<std::string> &keys) const
   {
      if (!value_.is_object())
      {
         refuse("keys and values in braces, with the keys " + listed(keys));
      }
      for (const auto &item : value_.items())
      {
         require(std::find(keys.begin(), keys.end(), item.key()) != keys.end(), called(),
                 ": unknown key '", item.key(), "', must be one of ", listed(keys));
      }
   }
   /// InputError if it has one of these keys, which nothing in space has.
   void must_not_have_in_space(const std::vector<std::string> &keys) const
   {
      for (const std::string &other : keys)
      {
         require(!has(other), called(), " has the key ", other,
                 ", which is not for bodies in space: leave it out");
      }
   }
   std::string text(const std::string &allowed = "a string") const
   {
      if (!value_.is_string()) { refuse(allowed); }
      return value_.get<std::string>();
   }
   std::string file() const
   {
      const std::string name = text();
      require(!name.empty(), called(), " is empty, must name a file");
      return name;
   }
   double number(const Check &check = any) const
   {
      if (!value_.is_number()) { refuse("a number"); }
      const double x = value_.get<double>();
      require(check.holds(x), called(), " is ", x, ", ", check.must);
      return x;
   }
   bool flag() const
   {
      if (!value_.is_boolean()) { refuse("true or false"); }
      return value_.get<bool>();
   }
   /// A list; a single value counts as a list of one.
   std::vector<Key> list() const
   {
      std::vector<Key> keys;
      if (!value_.is_array()) { return {*this}; }
      for (std::size_t k = 0; k < value_.size(); ++k)
      {
         keys.emplace_back(value_[k], path_ + "." + std::to_string(k));
      }
      return keys;
   }
   std::vector<double> numbers(const Check &check) const
   {
      std::vector<double> all;
      for (const Key &key : list()) { all.push_back(key.number(check)); }
      require(!all.empty(), called(), " is empty, must have a number");
      return all;
   }
   /// A number, a list of them, or an object of numbers by names.
   JointCase::Body::Constants constants(const Check &check) const
   {
      JointCase::Body::Constants made;
      if (!value_.is_object()) { made.values = numbers(check); }
      else
      {
         require(!value_.empty(), called(), " is empty, must have a number");
         for (const auto &item : value_.items())
         {
            made.named[item.key()] = (*this)[item.key()].number(check);
         }
      }
      return made;
   }
   std::string statements() const
   {
      std::vector<std::string> all;
      for (const Key &key : list())
      {
         all.push_back(key.text("a string, or a list of strings"));
      }
      return listed(all, "; ");
   }
   std::string choice(const std::vector<std::string> &choices) const
   {
      const std::string word = text();
      require(std::find(choices.begin(), choices.end(), word) != choices.end(), called(), ": '",
              word, "' is not one of ", listed(choices));
      return word;
   }
   std::array<double, 2> pair(const std::string &allowed = "two numbers") const
   {
      if (!value_.is_array()) { refuse(allowed); }
      require(value_.size() == 2, called(), " is a list of ", value_.size(), ", must be ",
              allowed);
      const std::vector<double> both = numbers(any);
      return {both[0], both[1]};
   }
   Eigen::Vector3d triple(const std::string &allowed = "three numbers") const
   {
      if (!value_.is_array() || value_.size() != 3) { refuse(allowed); }
      const std::vector<double> all = numbers(any);
      return {all[0], all[1], all[2]};
   }
   JointCase::Profile profile(const Check &check, bool in_space) const
   {
      JointCase::Profile made;
      if (value_.is_string())
      {
         made.function.emplace(called(), text(),
                               in_space ? std::vector<std::string>{"x", "y", "z"}
                                        : std::vector<std::string>{"s", "x", "y"});
      }
      else if (in_space && !value_.is_number())
      {
         refuse("a number, or a function of the place x, y, z");
      }
      else if (value_.is_number()) { made.points = {{0, number(check)}}; }
      else
      {
         if (!value_.is_array() || value_.size() < 2)
         {
            refuse("a number, a function of the arc length s and the place x, y, or a table "
                   "[[arc length, value], "
                   "…] of two points or more");
         }
         for (const Key &point : list())
         {
            made.points.push_back(point.pair("a point [arc length, value]"));
            require(check.holds(made.points.back()[1]), point.called(), ": ",
                    made.points.back()[1], " ", check.must);
            const std::size_t k = made.points.size() - 1;
            require(k == 0 || made.points[k][0] > made.points[k - 1][0], point.called(),
                    ": arc length ", made.points[k][0], " follows ",
                    k ? made.points[k - 1][0] : 0.0, ", must increase");
         }
      }
      return made;
   }

private:
   const ordered_json &value_;
   std::string path_;
};

JointCase::Source source(const Key &key)
{
   return {key.path()};
}

/// Names occur in statements and in names of files.
void check_name(const Key &key, const std::string &name)
{
   require(!name.empty() && name.find_first_of(" :=,;\"/\\\t\n") == std::string::npos,
           key.called(),
           ": a name must not be empty nor hold a space, a slash or any of : = , "
           "; \"");
}

/// "held", "free", {"force": "Q", "value": 10} or {"displacement": "D"}; about the centre
/// {"moment": …} or {"angle": …}.
Guide::Along along(const Key &key, bool turns)
{
   Guide::Along made;
   if (key.value().is_string())
   {
      made.motion =
         key.choice({"held", "free"}) == "held" ? Guide::Motion::held : Guide::Motion::free;
      return made;
   }
   const std::string force = turns ? "moment" : "force",
                     moves = turns ? "angle" : "displacement";
   key.must_be_of({force, moves, "value"});
   require(key.has(force) != key.has(moves), key.called(), " must have one of the keys ", force,
           " and ", moves);
   made.motion = key.has(force) ? Guide::Motion::force : Guide::Motion::displacement;
   const Key load = key[key.has(force) ? force : moves];
   made.load = load.text();
   check_name(load, made.load);
   if (key.has("value")) { made.value = key["value"].number(); }
   return made;
}

Guide guide_of(const Key &key)
{
   Guide made;
   if (key.has("x")) { made.x = along(key["x"], false); }
   if (key.has("y")) { made.y = along(key["y"], false); }
   if (key.has("rotation")) { made.rotation = along(key["rotation"], true); }
   if (key.has("centre"))
   {
      const std::array<double, 2> at = key["centre"].pair();
      made.centre = {at[0], at[1], 0};
   }
   return made;
}

JointCase::Body::Guided guided(const Key &key)
{
   key.must_be_of({"on", "x", "y", "rotation", "centre"});
   return {key["on"].text(), guide_of(key), source(key)};
}

/// The same in space, with three motions along the axes and three about them.
JointCase::Body::Guided guided_in_space(const Key &key)
{
   const std::vector<std::string> ways = {"x",          "y",          "z",
                                          "rotation-x", "rotation-y", "rotation-z"};
   key.must_be_of({"on", "x", "y", "z", "rotation-x", "rotation-y", "rotation-z", "centre"});
   JointCase::Body::Guided made{key["on"].text(), {}, source(key)};
   Guide &guide = made.guide;
   const std::array<Guide::Along *, 6> all = {
      &guide.x, &guide.y, &guide.z, &guide.rotation_x, &guide.rotation_y, &guide.rotation};
   for (std::size_t k = 0; k < ways.size(); ++k)
   {
      if (key.has(ways[k])) { *all[k] = along(key[ways[k]], k >= 3); }
   }
   if (key.has("centre"))
   {
      const Eigen::Vector3d at = key["centre"].triple();
      guide.centre = {at[0], at[1], at[2]};
   }
   return made;
}

/// Loads of a half-plane: "Q bulk-stress 40"; those of one name add up.
std::vector<BulkStress> bulk_stresses(const Key &key)
{
   std::vector<BulkStress> all;
   for (const std::string &statement : split(key.statements(), ";\n"))
   {
      const std::string where = key.called() + " '" + statement + "'";
      const std::vector<std::string> words = split(statement, " \t");
      require(words.size() == 3 && words[1] == "bulk-stress", where,
              ": must be PATTERN bulk-stress VALUE, a half-plane has no other loads");
      require_pattern_name(where, words[0]);
      const double stress = cattaneo::number(where, words[2]);
      const auto same =
         std::find_if(all.begin(), all.end(),
                      [&](const BulkStress &load) { return load.pattern == words[0]; });
      if (same == all.end()) { all.push_back({words[0], stress}); }
      else { same->stress += stress; }
   }
   return all;
}

/// Elastic constants, order, supports and loads.
void add_common(JointCase::Body &made, const Key &key)
{
   if (key.has("order"))
   {
      made.order = static_cast<int>(key["order"].number(within(1, 8)));
      require(made.order == key["order"].number(), key["order"].called(), " is ",
              key["order"].number(), ", must be a whole number");
   }
   if (key.has("expansion")) { made.expansion = key["expansion"].number(); }
   if (key.has("support")) { made.support = key["support"].statements(); }
   if (key.has("load")) { made.load = key["load"].statements(); }
}

/// {"points": [-4, -1, 1, 4], "cells": [6, 16, 6], "growth": [0.8, 1, 1.25]}
JointCase::Body::Brick::Axis brick_axis(const Key &key)
{
   key.must_be_of({"points", "cells", "growth"});
   JointCase::Body::Brick::Axis made;
   made.points = key["points"].numbers(any);
   require(made.points.size() > 1, key["points"].called(), " has ", made.points.size(),
           " number, must have two or more");
   for (std::size_t k = 1; k < made.points.size(); ++k)
   {
      require(made.points[k] > made.points[k - 1], key["points"].called(), ": ", made.points[k],
              " follows ", made.points[k - 1], ", must increase");
   }
   const std::size_t pieces = made.points.size() - 1;
   const Key cells = key["cells"];
   for (const double count : cells.numbers(within(1, 10000)))
   {
      made.cells.push_back(static_cast<int>(count));
      require(made.cells.back() == count, cells.called(), " has ", count,
              ", must have whole numbers");
   }
   made.growth.assign(pieces, 1);
   if (key.has("growth")) { made.growth = key["growth"].numbers(positive); }
   require(made.cells.size() == pieces && made.growth.size() == pieces, key.called(), " has ",
           made.points.size(), " points, ", made.cells.size(), " numbers of cells and ",
           made.growth.size(),
           " of growth, must have one cell and one growth fewer than points");
   return made;
}

/// A body in space: a mesh, or a block.
JointCase::Body body_in_space(const Key &key, const std::string &name)
{
   JointCase::Body made;
   made.name = name;
   made.source = source(key);
   key.must_not_have_in_space(
      {"split", "matrix", "deck", "mass", "half-plane", "geometry", "thickness"});
   key.must_be_of({"mesh", "part", "block", "young", "poisson", "density", "order", "expansion",
                   "support", "load", "guides"});
   require(key.has("mesh") != key.has("block"), key.called(), " has ",
           key.has("mesh") ? "both" : "none", " of the keys mesh and block, must have one");
   if (key.has("mesh")) { made.mesh = key["mesh"].file(); }
   else
   {
      const Key block = key["block"];
      block.must_be_of({"x", "y", "z", "elements"});
      made.brick = JointCase::Body::Brick();
      made.brick->axes = {brick_axis(block["x"]), brick_axis(block["y"]),
                          brick_axis(block["z"])};
      if (block.has("elements"))
      {
         made.brick->elements = block["elements"].choice({"hexahedra", "tetrahedra", "wedges"});
      }
   }
   if (key.has("part"))
   {
      require(!made.brick, key.called(),
              " has the keys block and part, which do not go together");
      made.part = key["part"].text();
   }
   // A deck may have materials of its own.
   const std::string ending = std::filesystem::path(made.mesh).extension().string();
   if ((ending != ".inp" && ending != ".INP") || key.has("young") || key.has("poisson"))
   {
      made.young = key["young"].constants(positive);
      made.poisson = key["poisson"].constants(any);
   }
   if (key.has("density")) { made.density = key["density"].constants(positive); }
   add_common(made, key);
   require(made.order <= 2, made.source.called("order"), " is ", made.order,
           ", in space it must be 1 or 2");
   if (key.has("guides"))
   {
      for (const Key &each : key["guides"].list())
      {
         made.guides.push_back(guided_in_space(each));
      }
   }
   return made;
}

JointCase::Body body(const Key &key, const std::string &name, bool as_meshed, bool in_space)
{
   check_name(key, name);
   if (in_space) { return body_in_space(key, name); }
   require(!key.value().is_object() || !key.has("block"), key.called(),
           " has the key block, which is for bodies in space: key 'analysis' must be space");
   JointCase::Body made;
   made.name = name;
   made.source = source(key);
   key.must_be_of({"mesh", "part", "split", "matrix", "deck", "mass", "half-plane", "young",
                   "poisson", "density", "order", "geometry", "expansion", "support", "load",
                   "guides", "thickness"});
   const bool is_matrix = key.has("matrix") || key.has("deck");
   const int kinds = key.has("mesh") + is_matrix + key.has("half-plane");
   require(kinds == 1, key.called(), " has ", kinds,
           " of the keys mesh, matrix (or deck) and half-plane, must have one");
   const auto goes_without = [&](const char *what, const std::vector<std::string> &keys)
   {
      for (const std::string &other : keys)
      {
         require(!key.has(other), key.called(), " has the keys ", what, " and ", other,
                 ", which do not go together");
      }
   };
   if (key.has("half-plane"))
   {
      goes_without("half-plane",
                   {"part", "split", "young", "poisson", "density", "mass", "order", "geometry",
                    "expansion", "support", "guides", "thickness"});
      const Key plane = key["half-plane"];
      plane.must_be_of({"young", "poisson", "depth"});
      made.half_plane = true;
      made.young.values = {plane["young"].number(positive)};
      made.poisson.values = {plane["poisson"].number(between(-1, 0.5))};
      if (plane.has("depth")) { made.depth = plane["depth"].number(positive); }
      if (key.has("load")) { made.bulk = bulk_stresses(key["load"]); }
      return made;
   }
   if (is_matrix)
   {
      goes_without(
         key.has("matrix") ? "matrix" : "deck",
         {"part", "split", "young", "poisson", "density", "expansion", "guides", "thickness"});
      if (key.has("deck")) { made.deck = key["deck"].file(); }
      made.matrix = key.has("matrix") ? key["matrix"].file() : matrix_of_deck(made.deck);
      if (key.has("mass")) { made.mass = key["mass"].file(); }
   }
   else
   {
      goes_without("mesh", {"mass"});
      made.mesh = key["mesh"].file();
      const std::string ending = std::filesystem::path(made.mesh).extension().string();
      if (key.has("part")) { made.part = key["part"].text(); }
      if (key.has("split")) { made.split = key["split"].text(); }
      // A deck may have materials of its own.
      if ((ending != ".inp" && ending != ".INP") || key.has("young") || key.has("poisson"))
      {
         require(
            key.has("young") || key.has("poisson"), key.called(),
            " has neither 'young' nor 'poisson', must have both: of meshes only decks (.inp) "
            "have materials in themselves, and '",
            made.mesh, "' is none");
         made.young = key["young"].constants(positive);
         made.poisson = key["poisson"].constants(any);
      }
   }
   if (key.has("density")) { made.density = key["density"].constants(positive); }
   add_common(made, key);
   made.as_meshed =
      key.has("geometry") ? key["geometry"].choice(geometries) == "as meshed" : as_meshed;
   if (key.has("thickness")) { made.thickness = key["thickness"].number(positive); }
   if (key.has("guides"))
   {
      for (const Key &each : key["guides"].list()) { made.guides.push_back(guided(each)); }
   }
   return made;
}

/// "pad:flank_left", or "ground" for a half-plane.
JointCase::Side side(const Key &key, const JointCase &joint)
{
   const std::string word =
      key.text("BODY:PART, or a list of two, [\"BODY:PART\", \"BODY:PART\"]");
   require(word.find_first_of(":") == word.rfind(':'), key.called(), ": '", word,
           "' has more than one colon, must be one BODY:PART: two sides are a list of two, "
           "[\"BODY:PART\", \"BODY:PART\"]");
   const std::size_t colon = std::min(word.find(':'), word.size());
   const JointCase::Side made{joint.body(word.substr(0, colon)),
                              word.substr(std::min(colon + 1, word.size())), key.called()};
   std::vector<std::string> names;
   for (const JointCase::Body &each : joint.bodies) { names.push_back(each.name); }
   require(made.body >= 0, key.called(), ": '", word, "': there is no body '",
           word.substr(0, colon), "', must be one of ", listed(names),
           colon == word.size() ? ", with a part of its boundary, as BODY:PART" : "");
   require(joint.bodies[made.body].half_plane == made.part.empty(), key.called(), ": '", word,
           "' must be ",
           made.part.empty() ? "a body and a part of its boundary, BODY:PART"
                             : "the name of the half-plane alone");
   return made;
}

/// In space {"plane": {"point": […], "normal": […]}}, {"sphere": {"centre": […], "radius": r}},
/// {"cylinder": {"point": […], "axis": […], "radius": r}} or {"height": "0.01*(x^2+y^2)"}.
void add_obstacle_in_space(JointCase::Face &face, const Key &key)
{
   using Shape = JointCase::Face::Solid::Shape;
   key.must_be_of({"plane", "sphere", "cylinder", "height"});
   require(key.value().size() == 1, key.called(),
           " must have one of the keys plane, sphere, cylinder and height");
   face.solid = JointCase::Face::Solid();
   JointCase::Face::Solid &solid = *face.solid;
   const auto set_axis = [&](const Key &axis)
   {
      solid.axis = axis.triple();
      require(solid.axis.norm() > 0, axis.called(), " is (0, 0, 0), must have a length");
   };
   const auto set_radius = [&](const Key &radius)
   {
      solid.radius = radius.number();
      require(solid.radius != 0, radius.called(),
              " is 0, must be positive, or negative for a hollow");
   };
   if (key.has("plane"))
   {
      const Key plane = key["plane"];
      plane.must_be_of({"point", "normal"});
      solid.point = plane["point"].triple();
      set_axis(plane["normal"]);
   }
   else if (key.has("sphere"))
   {
      const Key sphere = key["sphere"];
      sphere.must_be_of({"centre", "radius"});
      solid.shape = Shape::sphere;
      solid.point = sphere["centre"].triple();
      set_radius(sphere["radius"]);
   }
   else if (key.has("cylinder"))
   {
      const Key cylinder = key["cylinder"];
      cylinder.must_be_of({"point", "axis", "radius"});
      solid.shape = Shape::cylinder;
      solid.point = cylinder["point"].triple();
      set_axis(cylinder["axis"]);
      set_radius(cylinder["radius"]);
   }
   else
   {
      solid.shape = Shape::height;
      solid.height.emplace(key["height"].called(), key["height"].text(),
                           std::vector<std::string>{"x", "y"});
   }
}

/// {"line": [[x, y], [x, y], …]}, {"curve": "0.01*x^2"} or {"circle": {"centre": [x, y],
/// "radius": r}}.
void add_obstacle(JointCase::Face &face, const Key &key)
{
   key.must_be_of({"line", "circle", "curve"});
   require(key.value().size() == 1, key.called(),
           " must have one of the keys line, circle and curve");
   if (key.has("curve"))
   {
      face.curve.emplace(key["curve"].called(), key["curve"].text(),
                         std::vector<std::string>{"x"});
      return;
   }
   if (key.has("circle"))
   {
      const Key circle = key["circle"];
      circle.must_be_of({"centre", "radius"});
      const std::array<double, 2> centre = circle["centre"].pair();
      face.centre = {centre[0], centre[1]};
      face.radius = circle["radius"].number();
      return;
   }
   const Key line = key["line"];
   if (!line.value().is_array()) { line.refuse("a list of two points or more"); }
   require(line.value().size() >= 2, line.called(), " has ", line.value().size(),
           " point(s), must be a list of two points or more");
   for (const Key &point : line.list())
   {
      const std::array<double, 2> at = point.pair();
      face.obstacle.emplace_back(at[0], at[1]);
   }
}

/// {"D": {"y": -1}, "turn": {"angle": 1, "centre": [0, 5]}}
std::vector<JointCase::Motion> motions(const Key &key, bool in_space)
{
   if (!key.value().is_object() || key.value().empty())
   {
      key.refuse("loads by names in braces, as {\"D\": {\"y\": -1}}");
   }
   std::vector<JointCase::Motion> all;
   for (const auto &item : key.value().items())
   {
      const Key one = key[item.key()];
      check_name(one, item.key());
      if (in_space) { one.must_not_have_in_space({"angle", "centre"}); }
      one.must_be_of(in_space ? std::vector<std::string>{"x", "y", "z"}
                              : std::vector<std::string>{"x", "y", "angle", "centre"});
      JointCase::Motion made;
      made.load = item.key();
      if (one.has("x")) { made.along[0] = one["x"].number(); }
      if (one.has("y")) { made.along[1] = one["y"].number(); }
      if (one.has("z")) { made.along[2] = one["z"].number(); }
      if (one.has("angle")) { made.angle = one["angle"].number(); }
      if (one.has("centre"))
      {
         const std::array<double, 2> centre = one["centre"].pair();
         made.centre = {centre[0], centre[1]};
      }
      require(made.angle == 0 || one.has("centre"), one.called(),
              " turns the obstacle, it must have the key centre");
      require(made.along.norm() > 0 || made.angle != 0, one.called(),
              " moves nothing, must have x, y or ", in_space ? "z" : "angle", " that is not 0");
      all.push_back(made);
   }
   return all;
}

/// [[pressure, shear strength], …], which grow from (0, 0).
Eigen::MatrixX2d strength_points(const Key &key)
{
   if (!key.value().is_array() || key.value().empty())
   {
      key.refuse("a list of points [[pressure, shear strength], …]");
   }
   Eigen::MatrixX2d all(key.value().size(), 2);
   Eigen::RowVector2d before(0, 0);
   Eigen::Index k = 0;
   for (const Key &point : key.list())
   {
      const std::array<double, 2> at = point.pair("a point [pressure, shear strength]");
      require(at[0] > before[0] && at[1] >= before[1], point.called(), " is (", at[0], ", ",
              at[1], ") and follows (", before[0], ", ", before[1],
              "): pressures must grow from above 0, strengths must not fall");
      all.row(k++) = before = {at[0], at[1]};
   }
   return all;
}

JointCase::Face face(const Key &key, const std::string &name, const JointCase &joint)
{
   check_name(key, name);
   key.must_be_of({"between", "friction", "strength", "gap", "slave", "tied", "overlap",
                   "pairing", "obstacle", "motion", "guide"});
   const bool in_space = joint.in_space();
   if (in_space) { key.must_not_have_in_space({"strength", "pairing"}); }
   JointCase::Face made;
   made.name = name;
   made.source = source(key);
   const Key between_ = key["between"];
   const std::vector<Key> sides = between_.list();
   require(sides.size() == 1 || sides.size() == 2, between_.called(), " has ", sides.size(),
           " sides, must have two, or one that stands on a rigid line");
   for (std::size_t k = 0; k < sides.size(); ++k) { made.sides[k] = side(sides[k], joint); }
   require(!joint.bodies[made.sides[0].body].half_plane, between_.called(),
           ": a half-plane must be the second side");
   require(made.sides[0].body != made.sides[1].body || made.sides[0].part != made.sides[1].part,
           between_.called(), ": both sides are '", sides[0].text(),
           "', must be two parts that touch");
   if (key.has("tied")) { made.tied = key["tied"].flag(); }
   if (key.has("obstacle"))
   {
      require(sides.size() == 1, key.called(), ": an interface with an obstacle has ",
              sides.size(), " sides, must have one");
      require(
         !key.has("gap"), key.called(),
         ": has both obstacle and gap: leave gap out, the obstacle's place gives the gaps");
      if (in_space) { add_obstacle_in_space(made, key["obstacle"]); }
      else { add_obstacle(made, key["obstacle"]); }
   }
   require(!in_space || sides.size() == 2 || key.has("obstacle"), key.called(),
           " has one side and no obstacle: in space it must have a second side or the key "
           "obstacle");
   if (key.has("motion"))
   {
      require(sides.size() == 1, key.called(),
              ": only the rigid obstacle of an interface with one side can move");
      made.motions = motions(key["motion"], in_space);
   }
   if (key.has("guide"))
   {
      require(sides.size() == 1, key.called(),
              ": only the rigid obstacle of an interface with one side can have a guide");
      require(
         !key.has("motion"), key.called(),
         " has a guide and a motion, must have one of them: a guide has all motions of the "
         "obstacle");
      const Key guide = key["guide"];
      if (in_space)
      {
         guide.must_not_have_in_space({"rotation", "centre"});
         made.moves.emplace();
         const std::array<const char *, 3> axes = {"x", "y", "z"};
         for (int c = 0; c < 3; ++c)
         {
            if (guide.has(axes[c])) { (*made.moves)[c] = along(guide[axes[c]], false); }
         }
      }
      guide.must_be_of(in_space ? std::vector<std::string>{"x", "y", "z"}
                                : std::vector<std::string>{"x", "y", "rotation", "centre"});
      if (!in_space) { made.guide = guide_of(guide); }
      require(in_space || made.guide->centre ||
                 made.guide->rotation.motion == Guide::Motion::held,
              guide.called(), " lets the obstacle turn, must have the key centre");
   }
   for (const char *other :
        {"friction", "strength", "gap", "overlap", "pairing", "obstacle", "motion", "guide"})
   {
      require(!made.tied || !key.has(other), key.called(), " is tied, it goes without the key ",
              other);
   }
   if (key.has("friction")) { made.friction = key["friction"].profile(not_negative, in_space); }
   double most = 0;
   for (const std::array<double, 2> &point : made.friction.points)
   {
      most = std::max(most, point[1]);
   }
   if (most > 3)
   {
      warn(key["friction"].called() + " is " + message_text(most) +
           ": it is a coefficient such as 0.3, not a percentage");
   }
   if (key.has("strength"))
   {
      require(!key.has("friction"), key.called(),
              " has both friction and strength, which are two laws of friction");
      const Key strength = key["strength"];
      if (strength.value().is_object())
      {
         strength.must_be_of({"forward", "backward"});
         made.strength = {strength_points(strength["forward"]),
                          strength_points(strength["backward"])};
      }
      else { made.strength = {strength_points(strength), strength_points(strength)}; }
   }
   if (key.has("gap"))
   {
      const Key gap = key["gap"];
      const std::string word = gap.value().is_string() ? gap.text() : "";
      if (word == "closed") { made.gap = JointCase::Profile{{{0, 0}}, {}}; }
      else if (word.size() > 1 && std::all_of(word.begin(), word.end(), isalpha))
      {
         require(word == "geometry", gap.called(), " is '", word,
                 "', must be geometry, closed, a number",
                 in_space ? ", or a function of x, y and z"
                          : ", a function of s, x and y, or a table [[arc length, gap], …]");
      }
      else { made.gap = gap.profile(any, in_space); }
   }
   if (key.has("slave"))
   {
      const std::string word = key["slave"].choice(slaves);
      made.slave =
         static_cast<SlaveSide>(std::find(slaves.begin(), slaves.end(), word) - slaves.begin());
   }
   if (key.has("overlap")) { made.most_overlap = key["overlap"].number(not_negative); }
   if (key.has("pairing")) { made.pairing = key["pairing"].number(between(0, 0.5)); }
   return made;
}

JointCase::Bolt bolt(const Key &key, const std::string &name, const JointCase &joint)
{
   check_name(key, name);
   key.must_be_of({"between", "direction", "stiffness", "pretension", "preload"});
   JointCase::Bolt made;
   made.name = name;
   made.source = source(key);
   const Key between_ = key["between"];
   const std::vector<Key> ends = between_.list();
   require(ends.size() == 1 || ends.size() == 2, between_.called(), " has ", ends.size(),
           " ends, must have two, or one that is bolted to the ground");
   for (std::size_t k = 0; k < ends.size(); ++k)
   {
      made.ends[k] = side(ends[k], joint);
      require(!joint.bodies[made.ends[k].body].half_plane, ends[k].called(),
              ": a shank cannot end in a half-plane");
   }
   require(made.ends[0].body != made.ends[1].body || made.ends[0].part != made.ends[1].part,
           between_.called(), ": both ends are '", ends[0].text(),
           "', must be two parts that the shank pulls together");
   require(
      ends.size() == 2 || key.has("direction"), key.called(),
      " is bolted to the ground, it must have a direction, which points from the ground to "
      "the part that it pulls");
   if (key.has("direction"))
   {
      if (joint.in_space()) { made.direction = key["direction"].triple(); }
      else
      {
         const std::array<double, 2> along = key["direction"].pair();
         made.direction = Eigen::Vector3d(along[0], along[1], 0);
      }
      require(made.direction->norm() > 0, key.called(), ": its direction is (0, 0",
              joint.in_space() ? ", 0" : "", "), must have a length");
      made.direction->normalize();
   }
   made.stiffness = key["stiffness"].number(positive);
   require(key.has("pretension") != key.has("preload"), key.called(), " has ",
           key.has("preload") ? "both" : "none",
           " of the keys preload and pretension, must have "
           "one");
   made.tightened = key.has("preload");
   made.force = key[made.tightened ? "preload" : "pretension"].number(positive);
   return made;
}

/// [x, y], or {"body": "pad", "at": [x, y]}; in space [x, y, z].
JointCase::Point point(const Key &key, const std::string &name, const JointCase &joint)
{
   check_name(key, name);
   JointCase::Point made;
   made.name = name;
   const bool named = key.value().is_object();
   if (named)
   {
      key.must_be_of({"body", "at"});
      made.body = joint.body(key["body"].text());
      std::vector<std::string> names;
      for (const JointCase::Body &each : joint.bodies) { names.push_back(each.name); }
      require(made.body >= 0, key["body"].called(), ": there is no body '", key["body"].text(),
              "', must be one of ", listed(names));
   }
   const Key place = named ? key["at"] : key;
   if (joint.in_space()) { made.at = place.triple(); }
   else
   {
      const std::array<double, 2> at = place.pair();
      made.at = {at[0], at[1], 0};
   }
   return made;
}

/// Calls visit(name, does it prescribe displacements?) for every load that is named.
template <class Visit>
void each_load(JointCase &joint, Visit visit)
{
   const auto along = [&](Guide &guide)
   {
      for (Guide::Along *one : {&guide.x, &guide.y, &guide.rotation, &guide.z,
                                &guide.rotation_x, &guide.rotation_y})
      {
         if (one->load.empty()) { continue; }
         visit(one->load, one->motion == Guide::Motion::displacement);
      }
   };
   for (JointCase::Body &one : joint.bodies)
   {
      std::vector<std::string> statements;
      bool renamed = false;
      for (const std::string &statement : split(one.load, ";\n"))
      {
         std::vector<std::string> words = split(statement, " \t");
         if (words.size() > 1)
         {
            const bool moves = words[1].rfind("displacement-", 0) == 0 || words[1] == "twist";
            const std::string before = words[0];
            visit(words[0], moves);
            renamed = renamed || words[0] != before;
         }
         statements.push_back(listed(words, " "));
      }
      if (renamed) { one.load = listed(statements, "; "); }
      for (JointCase::Body::Guided &each : one.guides) { along(each.guide); }
      for (BulkStress &each : one.bulk) { visit(each.pattern, false); }
   }
   for (JointCase::Face &one : joint.faces)
   {
      if (one.guide) { along(*one.guide); }
      for (int c = 0; one.moves && c < 3; ++c)
      {
         Guide::Along &along = (*one.moves)[c];
         if (along.load.empty()) { continue; }
         visit(along.load, along.motion == Guide::Motion::displacement);
      }
      for (JointCase::Motion &each : one.motions) { visit(each.load, true); }
   }
   for (JointCase::Bolt &one : joint.bolts) { visit(one.name, false); }
}

/// A load that is a force on one body and a displacement of another is split into two, and the
/// second takes the multiplier of the first. A multiplier has one kind of conjugate.
void part_loads(JointCase &joint)
{
   std::map<std::string, std::array<bool, 2>> kinds; // forces, displacements
   each_load(joint, [&](std::string &name, bool moves) { kinds[name][moves ? 1 : 0] = true; });
   const auto both = [&](const std::string &name)
   {
      const auto found = kinds.find(name);
      return found != kinds.end() && found->second[0] && found->second[1];
   };
   const std::string moved = ".moved";
   for (const auto &[name, its] : kinds)
   {
      if (!both(name)) { continue; }
      require(kinds.count(name + moved) == 0, "load '", name,
              "' has forces and displacements, "
              "and there is a load '",
              name, moved,
              "', the name of its displacements in the results: rename one of the two");
      joint.go_with[name + moved] = name;
   }
   for (const JointCase::Bolt &bolt : joint.bolts)
   {
      require(!both(bolt.name), bolt.source.called("preload"), ": its load '", bolt.name,
              "' prescribes a displacement as well: give that a load of another name");
   }
   each_load(joint,
             [&](std::string &name, bool moves)
             {
                if (moves && both(name)) { name += moved; }
             });
}

/// The members of the object that a key has.
template <class Add>
void each(const ordered_json &all, const std::string &name, Add add)
{
   if (all.is_null()) { return; }
   const Key key(all, name);
   if (!all.is_object() || all.empty())
   {
      key.refuse("names with values in braces, as {\"NAME\": …}, one at least");
   }
   for (const auto &item : all.items()) { add(key[item.key()], item.key()); }
}

} // namespace

double JointCase::Profile::at(const Eigen::Vector3d &place) const
{
   return function ? (*function)({place[0], place[1], place[2]}) : points.front()[1];
}

double JointCase::Profile::at(double s, const Eigen::Vector2d &place) const
{
   if (function) { return (*function)({s, place[0], place[1]}); }
   const auto after = std::find_if(points.begin(), points.end(),
                                   [&](const auto &point) { return point[0] >= s; });
   if (after == points.begin()) { return after->at(1); }
   if (after == points.end()) { return points.back()[1]; }
   const auto &[s1, f1] = *after;
   const auto &[s0, f0] = *(after - 1);
   return f0 + (f1 - f0) * (s - s0) / (s1 - s0);
}

int JointCase::body(const std::string &name) const
{
   for (std::size_t b = 0; b < bodies.size(); ++b)
   {
      if (bodies[b].name == name) { return static_cast<int>(b); }
   }
   return -1;
}

ordered_json structure(const std::string &key, const std::string &text)
{
   try
   {
      return text.empty() ? ordered_json() : parsed(text);
   }
   catch (const ordered_json::exception &error)
   {
      throw InputError("key '" + key + "' is not JSON: " + error.what());
   }
}

JointCase joint_case(const JointKeys &keys, int order)
{
   JointCase joint;
   joint.order = order;
   const ordered_json analysis = keys.analysis;
   const std::string word = Key(analysis, "analysis").choice(analyses);
   joint.plane_stress = word == "plane stress";
   if (word == "axisymmetric") { joint.formulation = Formulation::axisymmetric; }
   if (word == "space")
   {
      joint.formulation = Formulation::space;
      require(order <= 2, "key 'order' is ", order, ", in space it must be 1 or 2");
      require(std::isnan(keys.thickness),
              "key 'thickness' is not for bodies in space: leave it out");
   }
   const ordered_json geometry = keys.geometry.empty() ? "smooth" : keys.geometry;
   const bool as_meshed = Key(geometry, "geometry").choice(geometries) == "as meshed";
   require(!keys.bodies.is_null(),
           "key 'bodies' is missing, must name the bodies (--case FILE reads a case, "
           "--example NAME prints one)");
   require(!keys.interfaces.is_null(),
           "key 'interfaces' is missing, must name where the bodies touch");
   each(keys.bodies, "bodies",
        [&](const Key &key, const std::string &name)
        { joint.bodies.push_back(body(key, name, as_meshed, joint.in_space())); });
   // A half-plane has no mesh, and is condensed to the lines of the bodies that stand on it.
   std::stable_partition(joint.bodies.begin(), joint.bodies.end(),
                         [](const JointCase::Body &one) { return !one.half_plane; });
   if (!std::isnan(keys.thickness)) { joint.thickness = keys.thickness; }
   for (const JointCase::Body &one : joint.bodies)
   {
      const bool plane = joint.formulation == Formulation::plane;
      require(std::isnan(one.thickness) || (plane && !std::isnan(keys.thickness)),
              one.source.called("thickness"), " is given ",
              plane ? "and that of the case is not: key 'thickness' must be there, forces are "
                      "those of the whole thickness then"
                    : "about an axis, must be left out");
      require(one.matrix.empty() || joint.thickness == 1, "key 'thickness' is ",
              joint.thickness, ", and body ", one.name,
              " is a matrix, whose stiffness already has its thickness: leave the key out");
   }
   require(std::isnan(keys.thickness) || joint.formulation == Formulation::plane,
           "key 'thickness' is given about an axis, must be left out");
   each(keys.interfaces, "interfaces",
        [&](const Key &key, const std::string &name)
        { joint.faces.push_back(face(key, name, joint)); });
   each(keys.bolts, "bolts",
        [&](const Key &key, const std::string &name)
        { joint.bolts.push_back(bolt(key, name, joint)); });
   each(keys.points, "points",
        [&](const Key &key, const std::string &name)
        { joint.points.push_back(point(key, name, joint)); });
   if (!keys.units.is_null())
   {
      const Key units(keys.units, "units");
      units.must_be_of({"length", "force"});
      joint.unit_of_length = units["length"].text();
      joint.unit_of_force = units["force"].text();
      for (const char *name : {"length", "force"})
      {
         const std::string word = units[name].text();
         require(
            !word.empty() && is_utf8(word) &&
               std::none_of(word.begin(), word.end(), [](unsigned char c) { return c <= ' '; }),
            units[name].called(), ": '", word, "' must be the name of a unit, as ",
            name == std::string("length") ? "mm" : "N");
      }
   }
   part_loads(joint);
   return joint;
}

} // namespace miniapp
