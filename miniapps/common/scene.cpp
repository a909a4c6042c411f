#include "common/scene.hpp"

#include "common/miniapp.hpp"
#include "common/text.hpp"

namespace miniapp
{

using namespace cattaneo;

ElasticBody &Scene::add(mfem::Mesh mesh, int order, const Material &material,
                        Formulation formulation)
{
   return add(std::move(mesh), order, std::vector<Material>{material}, formulation);
}

ElasticBody &Scene::add(mfem::Mesh mesh, int order, const std::vector<Material> &materials,
                        Formulation formulation)
{
   for (const Material &material : materials)
   {
      if (warn_of_locking(order, material)) { break; }
   }
   meshes.push_back(distribute(std::move(mesh), order));
   bodies.push_back(
      materials.size() == 1
         ? std::make_unique<ElasticBody>(*meshes.back(), order, materials[0], formulation)
         : std::make_unique<ElasticBody>(*meshes.back(), order, materials, formulation));
   dofs += bodies.back()->dofs();
   return *bodies.back();
}

void Scene::add_torsion(int order, const Material &material)
{
   for (const auto &mesh : meshes)
   {
      torsion.push_back(
         std::make_unique<ElasticBody>(*mesh, order, material, Formulation::torsion));
      dofs += torsion.back()->dofs();
   }
}

ReductionFields Scene::fields(const std::string &folder, const HalfPlane *half_plane)
{
   std::vector<const ElasticBody *> all;
   for (const auto &body : bodies) { all.push_back(body.get()); }
   return {reduction, all, folder, half_plane};
}

Material unit_material(double poisson)
{
   return {1 - poisson * poisson, poisson, PlaneState::strain};
}

Reduction stacked(CondensedBody above, const ElasticBody &below, const ContactLine &line)
{
   const Pairing pairing = pair_lines(above.line, line);
   return reduce(std::move(above), condense(below, line, condensation()), pairing);
}

mfem::Mesh half_turn(mfem::Mesh mesh)
{
   for (int v = 0; v < mesh.GetNV(); ++v)
   {
      for (int c = 0; c < 2; ++c) { mesh.GetVertex(v)[c] *= -1; }
   }
   return mesh;
}

bool warn_of_locking(int order, const Material &material)
{
   if (order > 1 || material.poisson < 0.49 || material.state != PlaneState::strain)
   {
      return false;
   }
   warn(exact_text("linear elements lock at Poisson's ratio ", material.poisson) +
        ": the body is too stiff; use option -order 2");
   return true;
}

} // namespace miniapp
