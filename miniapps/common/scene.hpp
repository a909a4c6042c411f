#pragma once

#include <cattaneo/elastic/body.hpp>
#include <cattaneo/output/paraview.hpp>
#include <cattaneo/reduced/reduction.hpp>
#include <memory>
#include <mfem.hpp>
#include <string>
#include <vector>

namespace miniapp
{

/// A part of a body that moves like a rigid block, and the loads that move it: their forces
/// stand at no node.
struct GuidedPart
{
   struct Load
   {
      std::string name;
      bool force = true;           ///< otherwise a displacement or an angle
      Eigen::Vector2d along{0, 0}; ///< the force or the displacement
      double moment = 0;           ///< about the centre, or the angle
   };
   int body = 0;
   std::string name;
   std::vector<int> dofs; ///< those of its nodes
   Eigen::Vector2d centre{0, 0};
   std::vector<Load> loads;
};

/// The bodies of a study and what they are reduced to. The bodies must live as long as the
/// reduction is used for fields.
struct Scene
{
   std::vector<std::unique_ptr<mfem::Mesh>> meshes;
   std::vector<std::unique_ptr<cattaneo::ElasticBody>> bodies;
   std::vector<std::unique_ptr<cattaneo::ElasticBody>> torsion; ///< on the same meshes, or none
   cattaneo::Reduction reduction;
   std::vector<GuidedPart> guides;
   int dofs = 0;                  ///< of all bodies
   std::vector<double> thickness; ///< of each body, by which its forces grow; empty: 1

   cattaneo::ReducedProblem &problem() { return reduction.problem; }
   const cattaneo::ReducedProblem &problem() const { return reduction.problem; }

   /// Makes a body on its own mesh, distributed like all bodies (distribute()); warns if it
   /// locks.
   cattaneo::ElasticBody &add(mfem::Mesh mesh, int order, const cattaneo::Material &material,
                              cattaneo::Formulation formulation = cattaneo::Formulation::plane);
   /// The same with one material, or one for each element attribute.
   cattaneo::ElasticBody &add(mfem::Mesh mesh, int order,
                              const std::vector<cattaneo::Material> &materials,
                              cattaneo::Formulation formulation = cattaneo::Formulation::plane);
   /// Makes the torsion bodies of all bodies, to be condensed with them.
   void add_torsion(int order, const cattaneo::Material &material);
   /// Series of the fields for ParaView in a folder; the scene must outlive them. `half_plane`:
   /// the last body, if it has no mesh.
   cattaneo::ReductionFields fields(const std::string &folder,
                                    const cattaneo::HalfPlane *half_plane = nullptr);
};

/// Material in plane strain with E' = E/(1-ν²) = 1.
cattaneo::Material unit_material(double poisson);

/// Two condensed bodies whose nodes match.
cattaneo::Reduction stacked(cattaneo::CondensedBody above, const cattaneo::ElasticBody &below,
                            const cattaneo::ContactLine &line);

/// The mesh turned by 180° about the origin.
mfem::Mesh half_turn(mfem::Mesh mesh);

/// Prints a line if linear elements will be much too stiff: order 1 and a Poisson's ratio of
/// 0.49 or more, except in plane stress. True if so.
bool warn_of_locking(int order, const cattaneo::Material &material);

} // namespace miniapp
