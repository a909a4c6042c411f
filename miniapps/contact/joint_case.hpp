#pragma once

#include "common/study.hpp"

#include <cattaneo/elastic/guide.hpp>
#include <cattaneo/expression.hpp>
#include <cattaneo/halfplane/half_plane.hpp>
#include <cattaneo/reduced/interfaces.hpp>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace miniapp
{

/** The content of a case: bodies, interfaces, bolts and points. Texts are in the language of
    docs/contact.md. */
struct JointCase
{
   /// Place in the case file, such as "bodies.pad".
   struct Source
   {
      std::string path;
      /// Its name in an error: "key 'bodies.pad.load'".
      std::string called(const std::string &key) const
      {
         return "key '" + path + "." + key + "'";
      }
   };
   struct Body
   {
      std::string name;
      Source source;
      std::string mesh, matrix; ///< mesh or matrix; neither for a half-plane or a brick
      std::string deck;         ///< the file with the places of the matrix's nodes, if named
      std::string mass;         ///< the file with the matrix's mass, if named
      std::string part;         ///< of a mesh that is a deck: instance or set of elements
      std::string split;        ///< a line of Gmsh along which the mesh is cut
      /// Elastic constants: one, one for each attribute, or by the names of groups of elements.
      struct Constants
      {
         std::vector<double> values;
         std::map<std::string, double> named;
         bool empty() const { return values.empty() && named.empty(); }
      };
      Constants young, poisson; ///< both empty: those of the deck
      Constants density;        ///< mass per volume; empty: not given
      double expansion = none;  ///< for temperature loads
      std::string support, load;
      struct Guided
      {
         std::string on; ///< part of the boundary
         cattaneo::Guide guide;
         Source source;
      };
      std::vector<Guided> guides;
      int order = 0;           ///< of its elements; 0: that of the case, or of the matrix
      double depth = none;     ///< of a half-plane
      double thickness = none; ///< if it differs from that of the case
      bool half_plane = false;
      std::vector<cattaneo::BulkStress> bulk; ///< of a half-plane, its loads
      /// Its sides are the polygons that they are meshed as, and not smooth curves.
      bool as_meshed = false;
      /// In space: cells of a brick, which need no mesh. Along each axis it is divided at
      /// points, between which it has so many cells, each longer than the one before by a
      /// factor.
      struct Brick
      {
         struct Axis
         {
            std::vector<double> points, growth;
            std::vector<int> cells;
         };
         std::array<Axis, 3> axes;
         std::string elements = "hexahedra";
      };
      std::optional<Brick> brick;
   };
   /// A number, a table over the arc length with straight lines between its points (beyond its
   /// ends constant), or a function of arc length and place.
   struct Profile
   {
      std::vector<std::array<double, 2>> points; ///< one point: the same number everywhere
      /// In place of points, of s, x and y; in space of x, y and z.
      std::optional<cattaneo::Expression> function;
      double at(double arc_length, const Eigen::Vector2d &place) const;
      double at(const Eigen::Vector3d &place) const; ///< in space, where there is no table
   };
   struct Side
   {
      int body = -1; ///< -1: a rigid line
      std::string part;
      std::string called; ///< in an error
   };
   /// Motion of a rigid obstacle per unit multiplier of a load: a translation and a rotation
   /// about a centre.
   struct Motion
   {
      std::string load;
      Eigen::Vector3d along{0, 0, 0}; ///< the third of it in space alone
      Eigen::Vector2d centre{0, 0};
      double angle = 0;
   };
   struct Face
   {
      std::string name;
      Source source;
      std::array<Side, 2> sides;
      Profile friction{{{0, 0}}, {}};
      std::optional<cattaneo::FrictionLaw> strength; ///< in place of friction, of tractions
      std::optional<Profile> gap;                    ///< not given: the geometry's
      cattaneo::SlaveSide slave = cattaneo::SlaveSide::coarser;
      double most_overlap = cattaneo::Interface().most_overlap;
      bool tied = false;
      /// Shape of a rigid obstacle: a polyline, a disc (a hole has a negative radius) or a
      /// curve y(x). None: the line that touches the side.
      std::vector<Eigen::Vector2d> obstacle;
      Eigen::Vector2d centre{0, 0};
      double radius = none;
      std::optional<cattaneo::Expression> curve;
      std::vector<Motion> motions;
      /// Guide of a rigid obstacle that is free in some way, or under forces.
      std::optional<cattaneo::Guide> guide;
      /// In space: the shape of a rigid obstacle, and how it moves along x, y and z.
      struct Solid
      {
         enum class Shape
         {
            plane,    ///< through a point, with a normal of any sign
            sphere,   ///< a hollow has a negative radius
            cylinder, ///< about an axis through a point; a bore has a negative radius
            height    ///< z as a function of x and y
         } shape = Shape::plane;
         Eigen::Vector3d point{0, 0, 0}; ///< of the plane or the axis, or the centre
         Eigen::Vector3d axis{0, 0, 1};  ///< or the normal of the plane
         double radius = none;
         std::optional<cattaneo::Expression> height;
      };
      std::optional<Solid> solid;
      std::optional<std::array<cattaneo::Guide::Along, 3>> moves;
      /// Nodes are paired one to one if partners are no farther apart along the contact than
      /// this, in distances of nodes.
      double pairing = none;
   };
   /// A shank between two parts of boundaries, or one part and the ground. Its name is that of
   /// the load that tightens it.
   struct Bolt
   {
      std::string name;
      Source source;
      std::array<Side, 2> ends; ///< the second without a body: the ground
      /// From the second end to the first. Not given: the line between their middles; in
      /// axisymmetry the direction of the axis.
      std::optional<Eigen::Vector3d> direction; ///< the third of it in space alone
      double stiffness = 1;
      /// The force of its load: the force that the bolt would have if the clamped parts were
      /// rigid, or with `tightened` the force when its tightening ends.
      double force = 1;
      bool tightened = false;
   };

   /// A place at which displacements and stresses are printed.
   struct Point
   {
      std::string name;
      Eigen::Vector3d at{0, 0, 0}; ///< the third of it in space alone
      int body = -1;               ///< -1: in any body that contains it
   };

   cattaneo::Formulation formulation = cattaneo::Formulation::plane;
   bool plane_stress = false;
   bool in_space() const { return formulation == cattaneo::Formulation::space; }
   int order = 2;
   /// Thickness of plane bodies without a thickness of their own. Forces are those of the whole
   /// thickness.
   double thickness = 1;
   std::vector<Body> bodies;
   std::vector<Face> faces;
   std::vector<Bolt> bolts;
   std::vector<Point> points;
   /// Units by their names, both or none.
   std::string unit_of_length, unit_of_force;
   /// For a load with forces and displacements its displacements are a separate load here, with
   /// another name and the same multiplier. That name → name of the load.
   std::map<std::string, std::string> go_with;

   int body(const std::string &name) const; ///< its number, -1: none
   double thickness_of(int body) const
   {
      return std::isnan(bodies[body].thickness) ? thickness : bodies[body].thickness;
   }
};

/// The values of the keys of a case; null: the key is missing.
struct JointKeys
{
   std::string analysis;
   nlohmann::ordered_json bodies, interfaces, bolts, points, units;
   std::string geometry = {};
   double thickness = none; ///< not given: forces are per thickness
};

/// The value of a key that is given as a text in JSON; null if the text is empty. InputError if
/// it is not JSON.
nlohmann::ordered_json structure(const std::string &key, const std::string &text);

/// InputError naming the key.
JointCase joint_case(const JointKeys &keys, int order);

} // namespace miniapp
