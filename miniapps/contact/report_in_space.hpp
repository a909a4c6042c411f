#pragma once

#include "common/study.hpp"
#include "contact/bolts_report.hpp"
#include "contact/contact_in_space.hpp"

#include <cattaneo/friction/march.hpp>

namespace miniapp
{

/// A direction in words: x, -y, or its components.
std::string direction_name(const Eigen::Vector3d &way);

/// The report of a case in space: resultants and areas of its interfaces, losses, loops,
/// reactions, and maps of the last state.
class ReportInSpace
{
public:
   /// An interface as a map: axes in its mean plane, along the axes of space where these lie in
   /// it, and triangles of its own nodes.
   struct Map
   {
      Eigen::Vector3d across{1, 0, 0}, up{0, 1, 0};
      std::vector<std::array<Eigen::Index, 3>> triangles;
      Eigen::Vector2d flat(const Eigen::Vector3d &x) const
      {
         return {across.dot(x), up.dot(x)};
      }
   };
   static Map map_of(const cattaneo::Reduction &reduction,
                     const cattaneo::InterfaceReport &face);

   /// All must outlive it.
   ReportInSpace(Study &study, const JointCase &joint, BodiesInSpace &own);
   /// A state that the march has reached, in this cycle (0: in none).
   void note(const cattaneo::ContactState &state, int cycle);
   /// Forces of the contact on the first body, of a case with one interface; also in the
   /// results.
   std::string of_state(const cattaneo::ContactState &state);
   /// The interfaces as maps, for the slider of the page: name, first node and end, places in
   /// the plane of the map, weights of the nodes, triangles, and words for the axes.
   nlohmann::ordered_json maps() const;
   /// Fields of a state on all nodes: pressure, shear on the first body and its slip along the
   /// axes of the map, and a letter for the state of each node (o: open, k: stick, s: slip).
   nlohmann::ordered_json fields(const cattaneo::ContactState &state) const;
   /// Tables, loops and maps, at the end.
   void report(const cattaneo::ContactState &state, const cattaneo::MarchReport &march,
               const BoltsReport &bolts);

private:
   /// The sum of the normal forces of an interface, and its force on the first side.
   struct Sum
   {
      double normal = 0, size = 0;
      Eigen::Vector3d force{0, 0, 0}, shear{0, 0, 0};
   };
   Sum sum(const cattaneo::InterfaceReport &face, const cattaneo::ContactState &state) const;
   /// The middle of the area where the sides of an interface face each other.
   Eigen::Vector3d middle(const cattaneo::InterfaceReport &face) const;
   /// Moments of an interface about a place.
   struct Moments
   {
      Eigen::Vector3d on_first{0, 0, 0};
      /// Size of the sum of those on both bodies: forces that do not act at one place leave it.
      /// NaN on an obstacle.
      double defect = none;
   };
   Moments moments(const cattaneo::InterfaceReport &face, const cattaneo::ContactState &state,
                   const Eigen::Vector3d &about) const;
   /// Tangential vectors (n × 3) of the nodes of an interface, of two components each.
   Eigen::MatrixX3d tangential(const cattaneo::InterfaceReport &face,
                               const Eigen::VectorXd &components) const;
   std::string first_body(const cattaneo::InterfaceReport &face) const;
   void report_interfaces(const cattaneo::ContactState &state,
                          const cattaneo::MarchReport &march);
   void report_cycles(const cattaneo::MarchReport &march);
   void report_reactions(const cattaneo::ContactState &state, const BoltsReport &bolts);
   void draw_loops();
   void draw_maps(const cattaneo::ContactState &state);

   Study &study_;
   const JointCase &joint_;
   BodiesInSpace &own_;
   const cattaneo::Reduction &reduction_;
   /// Mean slip of an interface, and the shear that resists it.
   struct Course
   {
      std::vector<Eigen::Vector3d> slip, shear; ///< as far as a picture can show
   };
   std::vector<Course> courses_;
   std::vector<Map> maps_; ///< of each interface
};

} // namespace miniapp
