#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cattaneo/elastic/assembly.hpp>
#include <cattaneo/input_error.hpp>
#include <limits>

namespace cattaneo
{

namespace
{

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Which nodes share an element, sorted.
mfem::Table neighbours(const mfem::FiniteElementSpace &space)
{
   mfem::Array<int> dofs;
   mfem::Table elements, of_node, graph;
   elements.MakeI(space.GetNE());
   for (int e = 0; e < space.GetNE(); ++e)
   {
      elements.AddColumnsInRow(e, space.GetFE(e)->GetDof());
   }
   elements.MakeJ();
   for (int e = 0; e < space.GetNE(); ++e)
   {
      space.GetElementDofs(e, dofs);
      elements.AddConnections(e, dofs, dofs.Size());
   }
   elements.ShiftUpI();
   mfem::Transpose(elements, of_node, space.GetNDofs());
   mfem::Mult(of_node, elements, graph);
   graph.SortRows();
   return graph;
}

/// Shape functions of the space and of the element's geometry at the points of a rule, one
/// column per point, and the integrals that affine elements share.
struct ReferenceElement
{
   VectorXd weight;
   MatrixXd shape, by_xi, by_eta;             // of the space
   MatrixXd place, place_by_xi, place_by_eta; // of the geometry
   MatrixXd xi_xi, xi_eta, eta_eta;           // ∫ ∂φi/∂ξ ∂φj/∂η …

   ReferenceElement(const mfem::FiniteElement &element, const mfem::FiniteElement &geometry,
                    const mfem::IntegrationRule &rule)
      : weight(rule.GetNPoints())
   {
      tabulate(element, rule, shape, by_xi, by_eta);
      tabulate(geometry, rule, place, place_by_xi, place_by_eta);
      for (int k = 0; k < rule.GetNPoints(); ++k) { weight[k] = rule.IntPoint(k).weight; }
      const MatrixXd xi = by_xi * weight.asDiagonal(), eta = by_eta * weight.asDiagonal();
      xi_xi = xi * by_xi.transpose();
      xi_eta = xi * by_eta.transpose();
      eta_eta = eta * by_eta.transpose();
   }

private:
   static void tabulate(const mfem::FiniteElement &element, const mfem::IntegrationRule &rule,
                        MatrixXd &value, MatrixXd &by_x, MatrixXd &by_y)
   {
      const int n = element.GetDof(), points = rule.GetNPoints();
      value.resize(n, points);
      by_x.resize(n, points);
      by_y.resize(n, points);
      mfem::Vector shape(n);
      mfem::DenseMatrix gradient(n, 2);
      for (int k = 0; k < points; ++k)
      {
         element.CalcShape(rule.IntPoint(k), shape);
         element.CalcDShape(rule.IntPoint(k), gradient);
         for (int i = 0; i < n; ++i)
         {
            value(i, k) = shape(i);
            by_x(i, k) = gradient(i, 0);
            by_y(i, k) = gradient(i, 1);
         }
      }
   }
};

/// Matrices of an element. block[c][d] (nodes × nodes) couples component c of the row's node to
/// component d of the column's node.
class Elements
{
public:
   std::array<std::array<MatrixXd, 2>, 2> block;

   /// A material for each attribute, or one that varies.
   Elements(const mfem::FiniteElementSpace &space, const std::vector<Material> *materials,
            const VaryingMaterial *varying, Formulation formulation)
      : space_(space), mesh_(*space.GetMesh()), materials_(materials), varying_(varying),
        formulation_(formulation)
   {
   }

   void compute(int e)
   {
      mesh_.GetElementTransformation(e, &transformation_);
      const mfem::FiniteElement &element = *space_.GetFE(e);
      auto &kept = references_[element.GetGeomType()];
      if (!kept)
      {
         kept = std::make_unique<ReferenceElement>(
            element, *transformation_.GetFE(),
            stiffness_rule(element, transformation_, formulation_, varying_ != nullptr));
      }
      const ReferenceElement &reference = *kept;
      const mfem::DenseMatrix &points = transformation_.GetPointMat();
      const Eigen::Map<const MatrixXd> corners(points.Data(), 2, points.Width());
      by_xi_.noalias() = corners * reference.place_by_xi;
      by_eta_.noalias() = corners * reference.place_by_eta;
      if (varying_)
      {
         vary(element, reference, corners);
         return;
      }
      const Material &material = (*materials_)[mesh_.GetAttribute(e) - 1];
      if (formulation_ == Formulation::plane && affine(corners))
      {
         integrate_affine(reference);
      }
      else { integrate(reference, corners, reference.weight); }
      combine(material.lambda(), material.mu());
   }

private:
   const mfem::FiniteElementSpace &space_;
   mfem::Mesh &mesh_;
   const std::vector<Material> *materials_;
   const VaryingMaterial *varying_;
   const Formulation formulation_;
   std::array<std::unique_ptr<ReferenceElement>, mfem::Geometry::NUM_GEOMETRIES> references_;
   mfem::IsoparametricTransformation transformation_;
   MatrixXd by_xi_, by_eta_; // of x and y (rows) at the points (columns)
   MatrixXd gx_, gy_, h_;    // ∂φ/∂x, ∂φ/∂y and φ/r
   MatrixXd weighted_;
   MatrixXd xx_, xy_, yy_, xh_, hy_, hh_; // integrals of their products, first by second

   /// Blocks of a material that varies within the element. They are linear in λ and μ, so one
   /// pass integrates with λ as a weight and a second one with μ.
   void vary(const mfem::FiniteElement &element, const ReferenceElement &reference,
             const Eigen::Map<const MatrixXd> &corners)
   {
      const mfem::IntegrationRule &points =
         stiffness_rule(element, transformation_, formulation_, true);
      VectorXd with_lambda = reference.weight, with_mu = reference.weight;
      for (int k = 0; k < points.GetNPoints(); ++k)
      {
         transformation_.SetIntPoint(&points.IntPoint(k));
         const Material material = varying_->at(transformation_);
         with_lambda[k] *= material.lambda();
         with_mu[k] *= material.mu();
      }
      integrate(reference, corners, with_lambda);
      combine(1, 0);
      const auto first = block;
      integrate(reference, corners, with_mu);
      combine(0, 1);
      for (int c : {0, 1})
      {
         for (int d : {0, 1}) { block[c][d] += first[c][d]; }
      }
   }

   void combine(double lambda, double mu)
   {
      if (formulation_ == Formulation::torsion)
      {
         block[0][0] = mu * (xx_ + yy_);
         mirror(block[0][0]);
         return;
      }
      block[0][0] = (lambda + 2 * mu) * xx_ + mu * yy_;
      block[1][1] = (lambda + 2 * mu) * yy_ + mu * xx_;
      block[0][1] = lambda * xy_ + mu * xy_.transpose();
      if (formulation_ == Formulation::axisymmetric)
      {
         block[0][0] += (lambda + 2 * mu) * hh_ + lambda * (xh_ + xh_.transpose());
         block[0][1] += lambda * hy_;
      }
      mirror(block[0][0]);
      mirror(block[1][1]);
      block[1][0] = block[0][1].transpose();
   }

   /// Makes a block symmetric to the last bit, whatever the order of its sums.
   static void mirror(MatrixXd &symmetric)
   {
      symmetric.triangularView<Eigen::StrictlyUpper>() = symmetric.transpose();
   }

   /// Is the mapping of the element linear, to the round-off of the coordinates?
   bool affine(const Eigen::Map<const MatrixXd> &corners) const
   {
      const double round_off =
         8 * std::numeric_limits<double>::epsilon() * corners.cwiseAbs().maxCoeff();
      for (Eigen::Index k = 1; k < by_xi_.cols(); ++k)
      {
         for (Eigen::Index c = 0; c < 2; ++c)
         {
            if (!(std::abs(by_xi_(c, k) - by_xi_(c, 0)) <= round_off) ||
                !(std::abs(by_eta_(c, k) - by_eta_(c, 0)) <= round_off))
            {
               return false;
            }
         }
      }
      return true;
   }

   void integrate_affine(const ReferenceElement &reference)
   {
      const double a = by_xi_(0, 0), b = by_eta_(0, 0), c = by_xi_(1, 0), d = by_eta_(1, 0);
      const double area = a * d - b * c;
      // ∂/∂x = (d ∂/∂ξ - c ∂/∂η)/area, ∂/∂y = (a ∂/∂η - b ∂/∂ξ)/area.
      const auto &xi = reference.xi_xi, &mixed = reference.xi_eta, &eta = reference.eta_eta;
      xx_ = (d * d / area) * xi + (c * c / area) * eta -
            (c * d / area) * (mixed + mixed.transpose());
      yy_ = (b * b / area) * xi + (a * a / area) * eta -
            (a * b / area) * (mixed + mixed.transpose());
      xy_ = (a * d / area) * mixed + (b * c / area) * mixed.transpose() - (b * d / area) * xi -
            (a * c / area) * eta;
   }

   /// Integrates the products of gradients. `weights` are those of the points on the reference
   /// element.
   void integrate(const ReferenceElement &reference, const Eigen::Map<const MatrixXd> &corners,
                  const VectorXd &weights)
   {
      const auto a = by_xi_.row(0).array(), b = by_eta_.row(0).array(),
                 c = by_xi_.row(1).array(), d = by_eta_.row(1).array();
      const Eigen::RowVectorXd area = a * d - b * c;
      const auto times = [&](const MatrixXd &by, const auto &x)
      { return (by.array().rowwise() * (x / area.array()).eval()).matrix().eval(); };
      gx_ = times(reference.by_xi, d) - times(reference.by_eta, c);
      gy_ = times(reference.by_eta, a) - times(reference.by_xi, b);
      VectorXd weight = weights.cwiseProduct(area.transpose());
      if (formulation_ != Formulation::plane)
      {
         const VectorXd radius = (corners.row(0) * reference.place).transpose();
         h_ = reference.shape.array().rowwise() / radius.transpose().array();
         for (Eigen::Index k = 0; k < weight.size(); ++k)
         {
            const double arm = lever(formulation_, radius[k]);
            weight[k] *= measure(formulation_, radius[k]) * arm * arm;
         }
      }
      weighted_.noalias() = gx_ * weight.asDiagonal();
      xx_.noalias() = weighted_ * gx_.transpose();
      if (formulation_ != Formulation::torsion) { xy_.noalias() = weighted_ * gy_.transpose(); }
      if (formulation_ == Formulation::axisymmetric)
      {
         xh_.noalias() = weighted_ * h_.transpose();
      }
      weighted_.noalias() = gy_ * weight.asDiagonal();
      yy_.noalias() = weighted_ * gy_.transpose();
      if (formulation_ == Formulation::axisymmetric)
      {
         hy_.noalias() = h_ * weighted_.transpose();
         weighted_.noalias() = h_ * weight.asDiagonal();
         hh_.noalias() = weighted_ * h_.transpose();
      }
   }
};

/// λ or μ, with a material for each attribute or one that varies.
class Lame : public mfem::Coefficient
{
public:
   Lame(double (Material::*constant)() const, const std::vector<Material> *materials,
        const VaryingMaterial *varying)
      : constant_(constant), materials_(materials), varying_(varying)
   {
   }
   double Eval(mfem::ElementTransformation &at, const mfem::IntegrationPoint &point) override
   {
      if (!varying_) { return ((*materials_)[at.Attribute - 1].*constant_)(); }
      at.SetIntPoint(&point);
      return (varying_->at(at).*constant_)();
   }

private:
   double (Material::*constant_)() const;
   const std::vector<Material> *materials_;
   const VaryingMaterial *varying_;
};

/// MFEM's integrator, at the points of stiffness_rule().
class SolidIntegrator : public mfem::ElasticityIntegrator
{
public:
   SolidIntegrator(mfem::Coefficient &lambda, mfem::Coefficient &mu, bool varying)
      : mfem::ElasticityIntegrator(lambda, mu), varying_(varying)
   {
   }
   void AssembleElementMatrix(const mfem::FiniteElement &element,
                              mfem::ElementTransformation &at,
                              mfem::DenseMatrix &matrix) override
   {
      const auto &transformation = dynamic_cast<const mfem::IsoparametricTransformation &>(at);
      SetIntRule(&stiffness_rule(element, transformation, Formulation::space, varying_));
      mfem::ElasticityIntegrator::AssembleElementMatrix(element, at, matrix);
   }

private:
   bool varying_;
};

/// A body in space is assembled by MFEM.
std::unique_ptr<mfem::SparseMatrix> assembled_by_mfem(const mfem::FiniteElementSpace &space,
                                                      const std::vector<Material> *materials,
                                                      const VaryingMaterial *varying)
{
   Lame lambda(&Material::lambda, materials, varying), mu(&Material::mu, materials, varying);
   // A form does not change its space, although it takes a pointer to one that is not const.
   mfem::BilinearForm form(const_cast<mfem::FiniteElementSpace *>(&space));
   form.AddDomainIntegrator(new SolidIntegrator(lambda, mu, varying != nullptr));
   form.Assemble();
   form.Finalize();
   return std::unique_ptr<mfem::SparseMatrix>(form.LoseMat());
}

std::unique_ptr<mfem::SparseMatrix> assembled(const mfem::FiniteElementSpace &space,
                                              Elements elements, Formulation formulation)
{
   const mfem::Table graph = neighbours(space);
   const int nodes = space.GetNDofs(), components = cattaneo::components(formulation);
   const int size = components * nodes;
   const std::size_t entries =
      static_cast<std::size_t>(graph.Size_of_connections()) * components * components;
   const int most = std::numeric_limits<int>::max();
   require(entries <= static_cast<std::size_t>(most), "elastic body: the stiffness of ", nodes,
           " nodes has ", entries, " entries, must have at most ", most,
           ": use fewer elements, or distribute the mesh over several ranks");
   // The matrix becomes the owner of these arrays and frees them.
   int *I = new int[size + 1], *J = new int[entries];
   double *data = new double[entries];
   std::fill(data, data + entries, 0.0);
   I[0] = 0;
   for (int i = 0; i < nodes; ++i)
   {
      for (int c = 0; c < components; ++c)
      {
         int at = I[components * i + c];
         for (int k = 0; k < graph.RowSize(i); ++k)
         {
            for (int d = 0; d < components; ++d)
            {
               J[at++] = components * graph.GetRow(i)[k] + d;
            }
         }
         I[components * i + c + 1] = at;
      }
   }
   auto K = std::make_unique<mfem::SparseMatrix>(I, J, data, size, size, true, true, true);

   mfem::Array<int> dofs;
   for (int e = 0; e < space.GetNE(); ++e)
   {
      space.GetElementDofs(e, dofs);
      elements.compute(e);
      for (int a = 0; a < dofs.Size(); ++a)
      {
         const int i = dofs[a];
         const int *row = graph.GetRow(i), *end = row + graph.RowSize(i);
         for (int b = 0; b < dofs.Size(); ++b)
         {
            const auto at = components * (std::lower_bound(row, end, dofs[b]) - row);
            for (int c = 0; c < components; ++c)
            {
               double *entry = data + I[components * i + c] + at;
               for (int d = 0; d < components; ++d) { entry[d] += elements.block[c][d](a, b); }
            }
         }
      }
   }
   return K;
}

} // namespace

const mfem::IntegrationRule &
stiffness_rule(const mfem::FiniteElement &element,
               const mfem::IsoparametricTransformation &transformation, Formulation formulation,
               bool varying_material)
{
   // In bodies of revolution the integrand is a product of two gradients of shape functions and
   // of a power of the radius (r, in torsion r³). On straight triangles and on quads with
   // parallel sides the rule is exact for it. On other quads it is exact for one gradient times
   // that power.
   const int order =
      !about_axis(formulation)
         ? 2 * transformation.OrderGrad(&element)
         : 2 * element.GetOrder() +
              (formulation == Formulation::torsion ? 4 : 2) * transformation.Order();
   const mfem::IntegrationRule &rule = mfem::IntRules.Get(element.GetGeomType(), order);
   if (!varying_material) { return rule; }
   return mfem::IntRules.Get(element.GetGeomType(), rule.GetOrder() + 4);
}

std::unique_ptr<mfem::SparseMatrix> assemble_stiffness(const mfem::FiniteElementSpace &space,
                                                       const std::vector<Material> &materials,
                                                       Formulation formulation)
{
   if (formulation == Formulation::space)
   {
      return assembled_by_mfem(space, &materials, nullptr);
   }
   return assembled(space, {space, &materials, nullptr, formulation}, formulation);
}

std::unique_ptr<mfem::SparseMatrix> assemble_stiffness(const mfem::FiniteElementSpace &space,
                                                       const VaryingMaterial &material,
                                                       Formulation formulation)
{
   if (formulation == Formulation::space)
   {
      return assembled_by_mfem(space, nullptr, &material);
   }
   return assembled(space, {space, nullptr, &material, formulation}, formulation);
}

} // namespace cattaneo
