//  heated_block: contact in a few lines added to a program of your own (MFEM's style, as ex2)
//
//  The right half of a block 2L wide and h high is held at the top and grows toward a rigid
//  plane at a distance g as its temperature rises by ΔT. All of the body belongs to the
//  program: mesh, H1 space, bilinear form, coefficients, thermal load and stresses. Cattaneo
//  takes the matrix, the forces and the held true dofs, and finds the contact. Without
//  friction the pressure is uniform in plane strain,
//
//     p = E α ΔT / (1 - ν) - E g / ((1 - ν²) h),  or 0 if the block does not reach the plane.
//
//  With MPI mesh and matrices are distributed.
//
//  Sample runs:
//    heated_block
//    heated_block -g 0.001 -o 1 -nu 0.2
//    heated_block -g 0.01
//    heated_block -f 0.3 -paraview heated

#include <cattaneo/contact/condense_body.hpp>
#include <cattaneo/elastic/views.hpp>
#include <cattaneo/friction/march.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/output/paraview.hpp>
#include <cattaneo/reduced/reduction.hpp>
#include <fstream>
#include <iostream>

using namespace mfem;

int main(int argc, char *argv[])
{
#ifdef MFEM_USE_MPI
   Mpi::Init(argc, argv);
   Hypre::Init();
   const bool root = Mpi::Root();
#else
   const bool root = true;
#endif

   // 1. Options.
   int order = 2, elements = 16;
   double E = 2.0, nu = 0.3, alpha = 0.01, rise = 0.5, gap = 0.0, friction = 0.0;
   const char *json = "", *paraview = "";
   OptionsParser args(argc, argv);
   args.AddOption(&order, "-o", "--order", "Order of the elements.");
   args.AddOption(&elements, "-n", "--elements", "Elements along the half width L = 1.");
   args.AddOption(&E, "-E", "--young", "Young's modulus.");
   args.AddOption(&nu, "-nu", "--poisson", "Poisson's ratio.");
   args.AddOption(&alpha, "-alpha", "--alpha", "Thermal expansion.");
   args.AddOption(&rise, "-dT", "--rise", "Rise of the temperature.");
   args.AddOption(&gap, "-g", "--gap", "Distance of the plane.");
   args.AddOption(&friction, "-f", "--friction", "Coefficient of friction.");
   args.AddOption(&json, "-json", "--json", "File for the results.");
   args.AddOption(&paraview, "-paraview", "--paraview", "Folder for the fields.");
   args.Parse();
   if (!args.Good())
   {
      if (root) { args.PrintUsage(std::cout); }
      return args.Help() ? 0 : 1;
   }

   try
   {
      cattaneo::require(order >= 1 && order <= 8, "option --order is ", order,
                        ", must be from 1 to 8");
      cattaneo::require(elements >= 1, "option --elements is ", elements,
                        ", must be at least 1");
      cattaneo::require_positive("option --young", E);
      cattaneo::require_between("option --poisson", nu, -1, 0.5);
   }
   catch (const cattaneo::InputError &error)
   {
      if (root) { std::cerr << "heated_block: " << error.what() << std::endl; }
      return 1;
   }

   // 2. The mesh: attributes 1 bottom, 2 right, 3 top, 4 left (the plane of symmetry).
   Mesh serial =
      Mesh::MakeCartesian2D(elements, elements, Element::QUADRILATERAL, true, 1.0, 1.0);
   H1_FECollection collection(order, 2);
#ifdef MFEM_USE_MPI
   ParMesh mesh(MPI_COMM_WORLD, serial);
   ParFiniteElementSpace space(&mesh, &collection, 2), scalars(&mesh, &collection);
   ParBilinearForm form(&space);
   ParMixedBilinearForm expansion(&space, &scalars);
#else
   Mesh &mesh = serial;
   FiniteElementSpace space(&mesh, &collection, 2), scalars(&mesh, &collection);
   BilinearForm form(&space);
   MixedBilinearForm expansion(&space, &scalars);
#endif

   // 3. The operator, and ∫ (3λ + 2μ) α T div v, the forces of a temperature T.
   ConstantCoefficient lambda(E * nu / ((1 + nu) * (1 - 2 * nu))), mu(E / (2 * (1 + nu)));
   ConstantCoefficient beta((3 * lambda.constant + 2 * mu.constant) * alpha);
   form.AddDomainIntegrator(new ElasticityIntegrator(lambda, mu));
   form.Assemble();
   form.Finalize();
   expansion.AddDomainIntegrator(new VectorDivergenceIntegrator(beta));
   expansion.Assemble();
   expansion.Finalize();
   Vector temperature(scalars.GetTrueVSize()), heat(space.GetTrueVSize());
   temperature = rise;
#ifdef MFEM_USE_MPI
   const std::unique_ptr<HypreParMatrix> K(form.ParallelAssemble());
   const std::unique_ptr<HypreParMatrix> divergence(expansion.ParallelAssemble());
   divergence->MultTranspose(temperature, heat);
#else
   const SparseMatrix *K = &form.SpMat();
   expansion.SpMat().MultTranspose(temperature, heat);
#endif

   // 4. The supports: the top, and the plane of symmetry with the contact node on it.
   Array<int> top({0, 0, 1, 0}), left({0, 0, 0, 1}), bottom({1, 0, 0, 0}), held_top, held_left;
   space.GetEssentialTrueDofs(top, held_top, 1);
   space.GetEssentialTrueDofs(left, held_left, 0);

   try
   {
      // 5. Contact.
      cattaneo::ElasticBody body(space, *K);
      body.fix(held_top);
      body.fix(held_left);
      body.add_forces("heat", heat);
      cattaneo::Reduction reduction =
         cattaneo::reduce(cattaneo::condense(body, cattaneo::contact_line(body, bottom)), gap);
      cattaneo::ReducedProblem &problem = reduction.problem;
      cattaneo::set_friction(problem, friction);
      cattaneo::ContactState state = cattaneo::ContactState::virgin(problem);
      const cattaneo::MarchReport report = cattaneo::march(
         problem, cattaneo::LoadHistory::through(problem, {{}, {{"heat", 1}}}), state);

      // 6. Results: nodal forces over consistent weights are pressures.
      const Eigen::VectorXd pressure = state.p.cwiseQuotient(problem.weights);
      const double expected =
         std::max(0.0, E * alpha * rise / (1 - nu) - E * gap / (1 - nu * nu));
      if (root)
      {
         std::cout << name(report.status) << ": ";
         if (state.p.maxCoeff() > 0)
         {
            std::cout << "pressure from " << pressure.minCoeff() << " to "
                      << pressure.maxCoeff() << ", without friction " << expected << std::endl;
         }
         else { std::cout << "the block does not reach the plane" << std::endl; }
         // If the solution is not unique, the report has the load from which on it is not, and
         // the node.
         if (report.status != cattaneo::FrictionStatus::converged)
         {
            std::cout << "from heat = " << report.event_multipliers[problem.pattern("heat")]
                      << " on: " << report.message << std::endl;
         }
      }
      if (root && *json)
      {
         std::ofstream file(json);
         file.precision(17);
         file << "{\"status\": \"" << name(report.status)
              << "\", \"least_pressure\": " << pressure.minCoeff()
              << ", \"largest_pressure\": " << pressure.maxCoeff()
              << ", \"slip_on_the_plane_of_symmetry\": " << state.v[0] << "}\n";
      }
      if (*paraview)
      {
         body.set_stress(
            [&](const GridFunction &u, ElementTransformation &at,
                const cattaneo::NamedLoads &on)
            {
               DenseMatrix strain;
               u.GetVectorGradient(at, strain);
               const double l = lambda.constant, m = mu.constant;
               const double mean = l * strain.Trace() - on.at("heat") * beta.constant * rise;
               return cattaneo::Stress{mean + 2 * m * strain(0, 0), mean + 2 * m * strain(1, 1),
                                       mean, m * (strain(0, 1) + strain(1, 0))};
            });
         cattaneo::BodyFields fields(body, paraview, "block");
         fields.write(reduction.displacement(0, state.v, state.w, state.multipliers), 1.0,
                      {{"heat", 1}});
      }
      return report.status == cattaneo::FrictionStatus::converged ? 0 : 2;
   }
   catch (const cattaneo::InputError &error)
   {
      std::cerr << "heated_block: " << error.what() << std::endl;
      return 1;
   }
}
