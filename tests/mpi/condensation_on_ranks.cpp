// Bodies on several ranks, gathered and factored or condensed by iterations, against the same
// body on one: stiffness, loads and fields. Exit code 1, with a sentence for each, where they
// differ.

#include <algorithm>
#include <cattaneo/contact/condense_body.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/reduced/reduction.hpp>
#include <cstdio>
#include <map>
#include <vector>

using namespace cattaneo;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace
{

int failures = 0;

void expect(bool good, const std::string &scene, const std::string &what, double found = 0)
{
   if (good) { return; }
   ++failures;
   std::printf("rank %d of %d: %s: %s (%g)\n", mfem::Mpi::WorldRank(), mfem::Mpi::WorldSize(),
               scene.c_str(), what.c_str(), found);
}

void expect_close(const MatrixXd &a, const MatrixXd &b, double tolerance,
                  const std::string &scene, const std::string &what)
{
   const bool shapes = a.rows() == b.rows() && a.cols() == b.cols();
   expect(shapes, scene, what + ": shapes differ");
   if (!shapes || a.size() == 0) { return; }
   const double worst = (a - b).cwiseAbs().maxCoeff() / b.cwiseAbs().maxCoeff();
   expect(worst <= tolerance, scene, what + " differs", worst);
}

mfem::Mesh mesh()
{
   // Wide elements, unequal ones, and (r > 0 too) no symmetry.
   mfem::Mesh mesh =
      mfem::Mesh::MakeCartesian2D(10, 6, mfem::Element::QUADRILATERAL, true, 2.0, 1.0);
   for (int v = 0; v < mesh.GetNV(); ++v)
   {
      double *x = mesh.GetVertex(v);
      x[0] += 0.1 * x[0] * (2 - x[0]) + 0.02 * x[1];
      x[1] *= 1 + 0.3 * x[1];
   }
   return mesh;
}

const int bottom = 1, right = 2, top = 3, left = 4;

struct Scene
{
   std::string name;
   Formulation formulation;
   bool held;
};

std::unique_ptr<ElasticBody> make_body(mfem::Mesh &mesh, const Scene &scene)
{
   auto body = std::make_unique<ElasticBody>(mesh, 2, Material{2.0, 0.3}, scene.formulation);
   if (scene.formulation == Formulation::torsion)
   {
      body->add_traction("T", right, 1.0);
      if (scene.held) { body->add_displacement("D", top, 0, 0.1); }
      return body;
   }
   body->add_pressure("P", scene.held ? right : top,
                      [](double x, double y) { return 1 + 0.2 * x - 0.1 * y; });
   body->add_traction("Q", right, 0.1, 0.3);
   if (!scene.held) { return body; }
   if (scene.formulation == Formulation::plane)
   {
      body->fix(BoundaryPart({left}, 1, 0.2, 2.0), 0);
   }
   body->add_displacement("D", top, 1, [](double x, double) { return -0.1 - 0.02 * x; });
   return body;
}

/// Field values by place and component.
using Field = std::map<std::tuple<long, long, int>, double>;

Field field(const ElasticBody &body, const VectorXd &values)
{
   Field result;
   const mfem::DenseMatrix &x = body.node_coordinates();
   for (int node = 0; node < x.Width(); ++node)
   {
      for (int c = 0; c < body.components(); ++c)
      {
         const int dof = body.true_dof(node, c);
         if (dof < 0) { continue; }
         result[{std::lround(1e7 * x(0, node)), std::lround(1e7 * x(1, node)), c}] =
            values(dof);
      }
   }
   return result;
}

void compare(const Scene &scene, int direct_dofs)
{
   const std::string name =
      scene.name + (direct_dofs ? ", gathered" : ", by conjugate gradients");
   // Energies of fields, and what is read off a field.
   const double tolerance = direct_dofs ? 1e-12 : 1e-10;
   mfem::Mesh whole = mesh();
   mfem::ParMesh shared(MPI_COMM_WORLD, whole);
   const auto alone = make_body(whole, scene), parts = make_body(shared, scene);
   CondenseSettings settings;
   settings.direct_dofs = direct_dofs;
   CondensedBody expected = condense(*alone, contact_line(*alone, bottom));
   const ContactLine line = contact_line(*parts, bottom);
   CondensedBody found = condense(*parts, line, settings);
   expect(parts->dofs() == alone->dofs(), name, "dofs differ");
   expect(found.rigid_modes == expected.rigid_modes, name, "rigid modes differ");
   expect((found.counters.krylov_iterations > 0) == (direct_dofs == 0), name,
          "it was not condensed as asked");
   expect_close(found.line.each(&LineNode::position), expected.line.each(&LineNode::position),
                1e-14, name, "position");
   expect_close(found.S, expected.S, tolerance, name, "S");
   expect_close(found.H, expected.H, tolerance, name, "H");
   for (std::size_t k = 0; k < expected.patterns.size(); ++k)
   {
      expect_close(found.patterns[k].q, expected.patterns[k].q, tolerance, name, "q");
      expect_close(found.patterns[k].p, expected.patterns[k].p, tolerance, name, "p");
   }
   // The same bits on all ranks.
   MatrixXd first = found.S;
   parts->ranks().share(first);
   expect(!parts->ranks().any(first != found.S), name, "S is not the same on all ranks");

   const VectorXd u = VectorXd::LinSpaced(expected.S.rows(), 1, 2).array().sin();
   const VectorXd multipliers =
      VectorXd::LinSpaced(static_cast<Eigen::Index>(expected.patterns.size()), 1, 2);
   const Field reference = field(*alone, expected.recover(u, multipliers));
   double largest = 0, worst = 0;
   for (const auto &entry : reference) { largest = std::max(largest, std::abs(entry.second)); }
   for (const auto &[place, value] : field(*parts, found.recover(u, multipliers)))
   {
      const auto there = reference.find(place);
      expect(there != reference.end(), name, "a node is not one of the whole mesh");
      if (there != reference.end())
      {
         worst = std::max(worst, std::abs(value - there->second));
      }
   }
   expect(worst <= 1e-10 * largest, name, "the field differs", worst / largest);

   // An equal body shares the factor, or what was iterated.
   const CondensedBody again = condense(*parts, line, settings, &found);
   expect(again.counters.factorisations == 0, name, "an equal body was condensed again");
   expect(again.S == found.S, name, "an equal body has another stiffness");
}

void expect_error(const std::string &part, const std::function<void()> &act)
{
   std::string message = "nothing";
   try
   {
      act();
   }
   catch (const InputError &error)
   {
      message = error.what();
   }
   expect(message.find(part) != std::string::npos, "error '" + part + "'", message);
}

/// MFEM's own elasticity form on several ranks, handed over as a matrix, against the operator
/// that the library assembles of the same material on one.
void compare_own_operator(int direct_dofs)
{
   const double tolerance = direct_dofs ? 1e-12 : 1e-10;
   const double young = 2, poisson = 0.3, mu = young / (2 * (1 + poisson)),
                lambda = 2 * mu * poisson / (1 - 2 * poisson);
   mfem::Mesh whole = mesh();
   mfem::ParMesh shared(MPI_COMM_WORLD, whole);
   mfem::H1_FECollection collection(2, 2);
   mfem::ConstantCoefficient first(lambda), second(mu);
   CondenseSettings settings;
   settings.direct_dofs = direct_dofs;
   for (const auto ordering : {mfem::Ordering::byNODES, mfem::Ordering::byVDIM})
   {
      const std::string name =
         std::string("own operator ") +
         (ordering == mfem::Ordering::byNODES ? "by nodes" : "by components") +
         (direct_dofs ? ", gathered" : ", by conjugate gradients");
      mfem::ParFiniteElementSpace space(&shared, &collection, 2, ordering);
      mfem::ParBilinearForm form(&space);
      form.AddDomainIntegrator(new mfem::ElasticityIntegrator(first, second));
      form.Assemble();
      form.Finalize();
      std::unique_ptr<mfem::HypreParMatrix> K(form.ParallelAssemble());
      ElasticBody own(space, *K), alone(whole, 2, Material{young, poisson});
      expect(!own.has_material(), name, "an operator of one's own has a material");
      for (ElasticBody *body : {&own, &alone})
      {
         body->fix(top, 0);
         body->fix(top, 1);
         body->add_pressure("P", right,
                            [](double x, double y) { return 1 + 0.2 * x - 0.1 * y; });
      }
      K.reset(); // it was copied
      CondensedBody found = condense(own, contact_line(own, bottom), settings);
      const CondensedBody expected = condense(alone, contact_line(alone, bottom));
      expect(own.dofs() == alone.dofs(), name, "dofs differ");
      expect_close(found.S, expected.S, tolerance, name, "S");
      expect_close(found.H, expected.H, tolerance, name, "H");
      expect_close(found.patterns[0].q, expected.patterns[0].q, tolerance, name, "q");
      expect_close(found.patterns[0].p, expected.patterns[0].p, tolerance, name, "p");
      expect(found.error_estimate() < 1e-6, name, "the stated error of S is large");
   }
}

/// MFEM's elasticity on an elastic foundation, along both axes or x alone: without supports
/// that motion is free which the operator does not resist, on any number of ranks. Against the
/// factor of the same form on one.
void compare_founded_operator(int direct_dofs)
{
   mfem::Mesh whole = mesh();
   mfem::ParMesh shared(MPI_COMM_WORLD, whole);
   mfem::H1_FECollection collection(2, 2);
   mfem::ConstantCoefficient first(1.5), second(0.8);
   mfem::DenseMatrix stiff(2);
   CondenseSettings settings;
   settings.direct_dofs = direct_dofs;
   for (const auto &[across, free] : {std::pair(0.7, 0), std::pair(0.0, 1)})
   {
      const std::string name = "operator on a foundation that leaves " + std::to_string(free) +
                               " motions free" +
                               (direct_dofs ? ", gathered" : ", by conjugate gradients");
      stiff = 0.0;
      stiff(0, 0) = 0.5;
      stiff(1, 1) = across;
      mfem::MatrixConstantCoefficient foundation(stiff);
      const auto add = [&](mfem::BilinearForm &form)
      {
         form.AddDomainIntegrator(new mfem::ElasticityIntegrator(first, second));
         form.AddDomainIntegrator(new mfem::VectorMassIntegrator(foundation));
         form.Assemble();
         form.Finalize();
      };
      mfem::ParFiniteElementSpace parts(&shared, &collection, 2);
      mfem::FiniteElementSpace space(&whole, &collection, 2);
      mfem::ParBilinearForm part(&parts);
      mfem::BilinearForm form(&space);
      add(part);
      add(form);
      const std::unique_ptr<mfem::HypreParMatrix> K(part.ParallelAssemble());
      ElasticBody own(parts, *K), alone(space, form.SpMat());
      for (ElasticBody *body : {&own, &alone}) { body->add_pressure("P", right, 1.0); }
      CondensedBody found = condense(own, contact_line(own, bottom), settings);
      const CondensedBody expected = condense(alone, contact_line(alone, bottom));
      expect(expected.rigid_modes == free, name, "rigid modes on one rank",
             expected.rigid_modes);
      expect(found.rigid_modes == free, name, "rigid modes", found.rigid_modes);
      expect_close(found.S, expected.S, direct_dofs ? 1e-12 : 1e-10, name, "S");
      expect_close(found.patterns[0].q, expected.patterns[0].q, 1e-10, name, "q");
      expect(found.error_estimate() < 1e-6, name, "the stated error of S is large");
   }
}

/// What cannot be an operator of one's own, on all ranks alike.
void errors_of_own_operators()
{
   mfem::Mesh whole = mesh();
   mfem::ParMesh shared(MPI_COMM_WORLD, whole);
   mfem::H1_FECollection linear(1, 2), quadratic(2, 2);
   mfem::ParFiniteElementSpace space(&shared, &quadratic, 2), coarse(&shared, &linear, 2),
      scalar(&shared, &quadratic);
   mfem::ParBilinearForm form(&space);
   form.AddDomainIntegrator(new mfem::VectorDiffusionIntegrator);
   form.Assemble();
   form.Finalize();
   const std::unique_ptr<mfem::HypreParMatrix> K(form.ParallelAssemble());
   expect_error("the stiffness on this rank is", [&] { ElasticBody(coarse, *K); });
   expect_error("the space has 1 components, must have 2", [&] { ElasticBody(scalar, *K); });
   mfem::Vector scale(K->Height());
   scale = 1.0;
   if (mfem::Mpi::WorldRank() == 0) { scale(0) = 2.0; } // wrong on one rank, said by all
   mfem::HypreParMatrix skew(*K);
   skew.ScaleRows(scale);
   expect_error("symmetric", [&] { ElasticBody(space, skew); });
}

/// An operator whose supports are eliminated is refused however it is condensed, also where
/// they are on one rank alone; with the same dofs fixed in the body it is right.
void eliminated_operators(int direct_dofs)
{
   mfem::Mesh whole = mesh();
   mfem::ParMesh shared(MPI_COMM_WORLD, whole);
   mfem::H1_FECollection collection(2, 2);
   mfem::ParFiniteElementSpace space(&shared, &collection, 2);
   mfem::ConstantCoefficient first(1.5), second(0.8);
   CondenseSettings settings;
   settings.direct_dofs = direct_dofs;
   const mfem::Array<int> on_top({0, 0, 1, 0});
   mfem::Array<int> all, one;
   space.GetEssentialTrueDofs(on_top, all);
   if (all.Size() > 0) { one.Append(all[0]); }
   MatrixXd expected;
   for (const mfem::Array<int> *dofs : {&one, &all})
   {
      mfem::ParBilinearForm form(&space);
      form.AddDomainIntegrator(new mfem::ElasticityIntegrator(first, second));
      form.Assemble();
      form.Finalize();
      const std::unique_ptr<mfem::HypreParMatrix> K(form.ParallelAssemble());
      const mfem::HypreParMatrix sound(*K);
      delete K->EliminateRowsCols(*dofs);
      ElasticBody body(space, *K);
      body.add_pressure("P", right, 1.0);
      const ContactLine line = contact_line(body, bottom);
      expect_error("was the operator eliminated?", [&] { condense(body, line, settings); });
      if (dofs != &all) { continue; }
      ElasticBody as_assembled(space, sound);
      for (ElasticBody *each : {&body, &as_assembled})
      {
         each->fix(top, 0);
         each->fix(top, 1);
      }
      const std::string name = direct_dofs ? "eliminated, gathered" : "eliminated, iterated";
      expect_close(condense(body, line, settings).S, condense(as_assembled, line, settings).S,
                   1e-10, name, "S");
   }
}

/// On all ranks alike.
void errors()
{
   mfem::Mesh whole = mesh();
   mfem::ParMesh shared(MPI_COMM_WORLD, whole);
   ElasticBody body(shared, 2, Material{2.0, 0.3});
   const ContactLine line = contact_line(body, bottom);
   CondenseSettings settings;
   settings.direct_dofs = -1;
   expect_error("direct_dofs", [&] { condense(body, line, settings); });
   settings.direct_dofs = 0;
   settings.max_iterations = 0;
   expect_error("max_iterations", [&] { condense(body, line, settings); });
   settings.max_iterations = 1;
   expect_error("1 iterations of conjugate gradients", [&] { condense(body, line, settings); });
   settings = {};
   // A side that is pushed takes a corner of the contact with it: the same on one rank.
   body.add_displacement("aside", left, 0, ScalarField([](double, double y) { return 1 + y; }));
   ElasticBody alone(whole, 2, Material{2.0, 0.3});
   alone.add_displacement("aside", left, 0,
                          ScalarField([](double, double y) { return 1 + y; }));
   const CondensedBody one = condense(alone, contact_line(alone, bottom));
   expect(one.moved.cwiseAbs().sum() > 0.9, "moved corner", "nothing moves");
   for (int direct_dofs : {0, 1000000})
   {
      settings.direct_dofs = direct_dofs;
      const CondensedBody shared_one = condense(body, line, settings);
      expect_close(shared_one.moved, one.moved, 1e-12, "moved corner", "what moves");
      expect_close(shared_one.S, one.S, 1e-8, "moved corner", "stiffness");
      expect_close(shared_one.patterns[0].q, one.patterns[0].q, 1e-8, "moved corner", "forces");
      expect_close(shared_one.H, one.H, 1e-8, "moved corner", "reaction");
   }
   ElasticBody loose(shared, 2, Material{2.0, 0.3});
   ContactLine point = contact_line(loose, bottom);
   point.nodes.resize(1);
   point.chains = {{0, 1}};
   for (int direct_dofs : {0, 1000000})
   {
      settings.direct_dofs = direct_dofs;
      expect_error("unsupported body", [&] { condense(loose, point, settings); });
   }
}

} // namespace

int main()
{
   mfem::Mpi::Init();
   mfem::Hypre::Init();
   for (const Scene &scene :
        {Scene{"held plane body", Formulation::plane, true},
         Scene{"free plane body", Formulation::plane, false},
         Scene{"held body of revolution", Formulation::axisymmetric, true},
         Scene{"free body of revolution", Formulation::axisymmetric, false},
         Scene{"held twisting body", Formulation::torsion, true},
         Scene{"free twisting body", Formulation::torsion, false}})
   {
      for (int direct_dofs : {0, 1000000}) { compare(scene, direct_dofs); }
   }
   for (int direct_dofs : {0, 1000000})
   {
      compare_own_operator(direct_dofs);
      compare_founded_operator(direct_dofs);
      eliminated_operators(direct_dofs);
   }
   errors_of_own_operators();
   errors();
   int all = 0;
   MPI_Allreduce(&failures, &all, 1, MPI_INT, MPI_SUM, MPI_COMM_WORLD);
   if (mfem::Mpi::Root())
   {
      std::printf("%d failures on %d ranks\n", all, mfem::Mpi::WorldSize());
   }
   return all == 0 ? 0 : 1;
}
