#include <cattaneo/condense/trace.hpp>
#include <cattaneo/input_error.hpp>

namespace cattaneo
{

std::string place_text(const Eigen::Vector3d &place, Formulation formulation)
{
   std::string text = "(" + exact_text(place[0]) + ", " + exact_text(place[1]);
   if (formulation == Formulation::space) { text += ", " + exact_text(place[2]); }
   return text + ")";
}

Trace::Trace(const ContactLine &line)
   : formulation(line.formulation), dofs(line.size(), components(line.formulation)),
     position(Eigen::MatrixX3d::Zero(line.size(), 3)), spacing(line.size())
{
   for (Eigen::Index i = 0; i < size(); ++i)
   {
      const LineNode &node = line.nodes[i];
      for (Eigen::Index c = 0; c < dofs.cols(); ++c) { dofs(i, c) = node.dofs[c]; }
      position(i, 0) = node.position[0];
      position(i, 1) = node.position[1];
      spacing[i] = node.spacing;
   }
}

Trace::Trace(const ContactSurface &surface)
   : formulation(Formulation::space), dofs(surface.size(), 3), position(surface.positions()),
     spacing(surface.size())
{
   for (Eigen::Index i = 0; i < size(); ++i)
   {
      const SurfaceNode &node = surface.nodes[i];
      for (Eigen::Index c = 0; c < 3; ++c) { dofs(i, c) = node.dofs[c]; }
      spacing[i] = node.spacing;
   }
}

} // namespace cattaneo
