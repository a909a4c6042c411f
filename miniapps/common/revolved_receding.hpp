#pragma once

#include <cattaneo/condense/reduction.hpp>
#include <memory>
#include <vector>

namespace miniapp
{

/** The axisymmetric receding contact of thesis chapter 7: a disc 0 < r < b, 0 < z < t on a
    cylinder 0 < r < R, -R < z < 0 of the same material, its far side and bottom fixed. A
    pressure p0 acts on the disc's top for r < a (pattern "load"); with torsion the top turns by
    a prescribed angle (pattern "rotation"). Units t = p0 = E = 1. The end of the load need not
    be a mesh line. */
struct RevolvedOptions
{
   double disc_radius = 5, load_radius = 2.5, domain = 100; ///< b, a, R in t
   double poisson = 0.3;
   int order = 2;
   double spacing = 0.02; ///< of the contact nodes, uniform
   double growth = 1.25;  ///< of the elements away from the contact
   bool torsion = false;  ///< builds the torsional bodies

   /// InputError naming the option, its value and what is allowed.
   void validate() const;
};

/// The bodies must live as long as their reduction is used for fields.
struct RevolvedReceding
{
   std::vector<std::unique_ptr<mfem::Mesh>> meshes;
   std::vector<std::unique_ptr<cattaneo::ElasticBody>> bodies; ///< disc, cylinder; if they
                                                               ///< twist, both again in torsion
   cattaneo::Reduction reduction;
   int dofs = 0; ///< of all bodies
};

RevolvedReceding make_receding(const RevolvedOptions &options);

} // namespace miniapp
