#include <cattaneo/contact/boundary_surface.hpp>
#include <cattaneo/elastic/boundary_edge.hpp>
#include <cattaneo/elastic/boundary_face.hpp>
#include <cattaneo/input_error.hpp>

namespace cattaneo
{

ContactSurface contact_surface(const ElasticBody &body, const BoundaryPart &part)
{
   const std::string where = "contact surface";
   require(body.formulation() == Formulation::space, where, ": the body is ",
           name(body.formulation()), ", must be in space");
   mfem::Mesh &mesh = *body.space().GetMesh();
   std::vector<std::vector<int>> faces;
   std::vector<Eigen::Vector3d> inside;
   mfem::Array<int> dofs;
   for (int i : boundary_elements(mesh, part, where))
   {
      BoundaryFace face(mesh, i);
      if (!face.within(part, where)) { continue; }
      body.space().GetBdrElementDofs(i, dofs);
      faces.emplace_back(dofs.begin(), dofs.end());
      inside.push_back(face.inside());
   }
   require(!faces.empty(), where, ": there are no faces inside the ", describe(part));
   const auto node = [&body](int scalar_dof)
   {
      SurfaceNode made;
      for (int c = 0; c < 3; ++c) { made.dofs[c] = body.true_dof(scalar_dof, c); }
      made.position = body.place(scalar_dof);
      return made;
   };
   return surface_of(
      faces, node, [&inside](std::size_t f) { return inside[f]; }, where);
}

} // namespace cattaneo
