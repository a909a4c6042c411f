#pragma once

#include "contact/own_bodies.hpp"

#include <cattaneo/output/streamed_file.hpp>
#include <optional>

namespace miniapp
{

/// Displacements and stresses at the points that a case names: at the end in a table, and with
/// --csv for each recorded state in PREFIX_point_history.csv.
class NamedPoints
{
public:
   /// All must outlive it. InputError for a point that is in no body.
   NamedPoints(Study &study, const JointCase &joint, Scene &scene,
               const cattaneo::HalfPlane *half_plane = nullptr);
   /// Begins the file, or continues it from a state.
   void begin(const cattaneo::ContactState &state);
   void note(const cattaneo::ContactState &state);
   void report(const cattaneo::ContactState &state);

private:
   /// A point in one of the bodies that contain it.
   struct Place
   {
      std::string name;
      int body = 0;
      Eigen::Vector3d at{0, 0, 0};
      int element = 0; ///< of a mesh
      mfem::IntegrationPoint within;
   };
   struct Value
   {
      Eigen::Vector3d displacement{0, 0, 0};
      cattaneo::Stress stress;
   };
   /// The numbers of a point, as in the table and in the file: place, displacement, stresses.
   std::vector<double> numbers(const Place &place, const Value &value) const;
   void find(const JointCase::Point &point);
   std::vector<Value> values(const cattaneo::ContactState &state);

   Study &study_;
   const JointCase &joint_;
   Scene &scene_;
   const cattaneo::HalfPlane *half_plane_;
   std::vector<Place> places_;
   std::optional<cattaneo::StreamedFile> file_;
   double last_ = none; ///< last recorded time, because the end of a march is observed twice
};

} // namespace miniapp
