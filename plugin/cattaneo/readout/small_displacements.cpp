#include <cattaneo/friction/contact_state.hpp>
#include <cattaneo/readout/small_displacements.hpp>
#include <cmath>
#include <sstream>

namespace cattaneo
{

using Eigen::Index;

SmallDisplacements::SmallDisplacements(const Reduction &reduction, std::vector<bool> even)
   : reduction_(reduction), even_(std::move(even)), slip_(reduction.interfaces.size()),
     gap_(reduction.interfaces.size())
{
   even_.resize(slip_.size(), false);
}

namespace
{

/// The length of an interface, in space the diagonal of the box around it.
double length_of(const ReducedProblem &problem, const InterfaceReport &face)
{
   if (face.places.rows() > 0)
   {
      return (face.places.colwise().maxCoeff() - face.places.colwise().minCoeff()).norm();
   }
   const auto along = problem.arc_length.segment(face.first, face.nodes);
   return along.maxCoeff() - along.minCoeff();
}

/// "(x, y)", in space "(x, y, z)".
std::string told_place(const Eigen::Vector3d &place, bool in_space)
{
   std::ostringstream text;
   text << "(" << place[0] << ", " << place[1];
   if (in_space) { text << ", " << place[2]; }
   text << ")";
   return text.str();
}

} // namespace

void SmallDisplacements::note(const ContactState &state)
{
   const Eigen::VectorXd &gaps = reduction_.problem.gap;
   for (std::size_t k = 0; k < slip_.size(); ++k)
   {
      const InterfaceReport &face = reduction_.interfaces[k];
      if (face.tied || face.spacing.size() != face.nodes) { continue; }
      const bool on_surface = face.places.rows() > 0;
      const double length = length_of(reduction_.problem, face);
      for (Index i = 0; i < face.nodes; ++i)
      {
         const Index node = face.first + i;
         if (!closed(state.status[node]) || state.p[node] <= 0) { continue; }
         const double slip = on_surface ? std::hypot(state.v[node], state.v[gaps.size() + node])
                                        : std::abs(state.v[node]),
                      share = slip / face.spacing[i];
         if (!even_[k] && share > slip_[k].share) { slip_[k] = {i, slip, share}; }
         const double gap = std::abs(gaps[node]);
         if (gap > gap_[k].share * length) { gap_[k] = {i, gap, gap / length}; }
      }
   }
}

std::vector<std::string> SmallDisplacements::warnings() const
{
   std::vector<std::string> all;
   for (std::size_t k = 0; k < slip_.size(); ++k)
   {
      const InterfaceReport &face = reduction_.interfaces[k];
      const auto add = [&](const Most &most, const char *what, const char *of, const char *then)
      {
         std::ostringstream text;
         const bool on_surface = face.places.rows() > 0;
         Eigen::Vector3d at(0, 0, 0);
         if (on_surface) { at = face.places.row(most.node); }
         else { at.head<2>() = face.position.row(most.node); }
         text << "interface '" << face.name << "': " << what << most.value << " at "
              << told_place(at, on_surface) << ", which is " << most.share << of
              << ": displacements are assumed to be small, " << then;
         all.push_back(text.str());
      };
      if (slip_[k].share > 1)
      {
         add(slip_[k], "a node slips by ", " of its distance from the next",
             "but it is computed as if it still faced the same place as at rest");
      }
      if (gap_[k].share > 0.1)
      {
         add(gap_[k], "contact closes or opens a gap of ", " of the length of the interface",
             "but the gap is measured along the normals at rest");
      }
   }
   return all;
}

std::string rotation_warning(const std::string &body, double rotation,
                             const Eigen::Vector3d &place, bool in_space)
{
   if (std::abs(rotation) <= 0.05) { return ""; }
   std::ostringstream text;
   text << "body " << body << " turns by " << rotation * 180 / std::acos(-1.0) << " degrees at "
        << told_place(place, in_space)
        << ": displacements are assumed to be small, so that its turned shape and the forces "
           "on it have a relative error "
           "of about this angle";
   return text.str();
}

} // namespace cattaneo
