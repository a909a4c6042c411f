#pragma once

#include <cattaneo/condense/contact_line.hpp>
#include <cattaneo/condense/contact_surface.hpp>

namespace cattaneo
{

/// A place in messages: "(x, y)", in space "(x, y, z)".
std::string place_text(const Eigen::Vector3d &place, Formulation formulation);

/// The nodes of a line or of a surface, for functions that condense and unite bodies.
struct Trace
{
   Formulation formulation = Formulation::plane;
   Eigen::MatrixXi dofs;      ///< n × components
   Eigen::MatrixX3d position; ///< n × 3; z is 0 except in space
   Eigen::VectorXd spacing;   ///< n

   Trace(const ContactLine &line);       // NOLINT: a line is a trace
   Trace(const ContactSurface &surface); // NOLINT: and so is a surface

   Eigen::Index size() const { return dofs.rows(); }
   /// "line" or "surface", in messages.
   const char *kind() const { return formulation == Formulation::space ? "surface" : "line"; }
   /// The place of a node in messages.
   std::string called(Eigen::Index node) const
   {
      return place_text(position.row(node), formulation);
   }
};

} // namespace cattaneo
