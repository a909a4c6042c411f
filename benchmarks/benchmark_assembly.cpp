//  benchmark_assembly: assembling and condensing a structured block, against MFEM's
//  BilinearForm
//
//  The same block, as mesh and as condensed stiffness, twice: with the operator that Cattaneo
//  assembles, and with the one of an mfem::BilinearForm handed over as a user's matrix (copied
//  and checked, as a user's is). Processor seconds, the best of several; the difference is of
//  the two condensed stiffnesses.

#include "axisymmetric_integrator.hpp"

#include <cattaneo/contact/condense_body.hpp>
#include <cattaneo/mesh/graded_mesh.hpp>
#include <cstdio>
#include <ctime>
#include <functional>

using namespace cattaneo;

namespace
{

double processor_seconds(int times, const std::function<void()> &act)
{
   double best = 1e300;
   for (int k = 0; k < times; ++k)
   {
      const std::clock_t began = std::clock();
      act();
      best = std::min(best, double(std::clock() - began) / CLOCKS_PER_SEC);
   }
   return best;
}

std::unique_ptr<mfem::BilinearForm> bilinear_form(mfem::FiniteElementSpace &space,
                                                  mfem::Coefficient &lambda,
                                                  mfem::Coefficient &mu,
                                                  Formulation formulation)
{
   auto form = std::make_unique<mfem::BilinearForm>(&space);
   if (formulation == Formulation::plane)
   {
      form->AddDomainIntegrator(new mfem::ElasticityIntegrator(lambda, mu));
   }
   else { form->AddDomainIntegrator(new AxisymmetricElasticityIntegrator(lambda, mu)); }
   form->Assemble(0);
   form->Finalize(0);
   return form;
}

Eigen::MatrixXd condensed(ElasticBody &&body)
{
   body.fix(3, 0);
   body.fix(3, 1);
   return condense(body, contact_line(body, 1)).S;
}

} // namespace

int main()
{
   const Material material{1.0, 0.3};
   std::printf("%-13s %5s %9s | %20s | %20s | %s\n", "", "", "", "assembly, s",
               "with condensation, s", "");
   std::printf("%-13s %5s %9s | %6s %6s %6s | %6s %6s %6s | %s\n", "geometry", "order", "dofs",
               "form", "ours", "ratio", "form", "ours", "ratio", "difference");
   for (auto formulation : {Formulation::plane, Formulation::axisymmetric})
   {
      for (int order = 1; order <= 4; ++order)
      {
         const int columns = 360 / order, rows = 180 / order;
         std::vector<double> x(columns + 1), y(rows + 1);
         for (int k = 0; k <= columns; ++k) { x[k] = 2.0 * k / columns; }
         for (int k = 0; k <= rows; ++k) { y[k] = 1.0 * k / rows; }
         mfem::Mesh mesh = rectangle_mesh(x, y);
         mfem::ConstantCoefficient lambda(material.lambda()), mu(material.mu());
         mfem::H1_FECollection collection(order, 2);
         Eigen::MatrixXd theirs, ours;
         int dofs = 0;
         const auto form = [&](bool further)
         {
            mfem::FiniteElementSpace space(&mesh, &collection, 2, mfem::Ordering::byVDIM);
            const auto made = bilinear_form(space, lambda, mu, formulation);
            if (further) { theirs = condensed(ElasticBody(space, made->SpMat(), formulation)); }
         };
         const auto body = [&](bool further)
         {
            ElasticBody made(mesh, order, material, formulation);
            dofs = made.dofs();
            if (further) { ours = condensed(std::move(made)); }
         };
         const double seconds[] = {processor_seconds(3, [&] { form(false); }),
                                   processor_seconds(3, [&] { body(false); }),
                                   processor_seconds(3, [&] { form(true); }),
                                   processor_seconds(3, [&] { body(true); })};
         std::printf("%-13s %5d %9d | %6.3f %6.3f %6.2f | %6.3f %6.3f %6.2f | %.1e\n",
                     formulation == Formulation::plane ? "plane" : "axisymmetric", order, dofs,
                     seconds[0], seconds[1], seconds[0] / seconds[1], seconds[2], seconds[3],
                     seconds[2] / seconds[3],
                     (theirs - ours).cwiseAbs().maxCoeff() / ours.cwiseAbs().maxCoeff());
         std::fflush(stdout);
      }
   }
   return 0;
}
