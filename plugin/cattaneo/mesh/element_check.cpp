#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cattaneo/algebra/dense_lu.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/mesh/element_check.hpp>
#include <cattaneo/mesh/ranks.hpp>
#include <cmath>
#include <limits>
#include <memory>
#include <sstream>
#include <vector>

namespace cattaneo
{

namespace
{

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Below this share of its largest value a determinant is zero.
constexpr double tolerance = 1e-10;

enum class Fault
{
   none,
   flat,   ///< no area
   turned, ///< negative determinant everywhere
   folded  ///< and positive elsewhere
};

/// Values at Chebyshev–Lobatto points of [0, 1], turned into Bernstein coefficients of that
/// degree.
struct Bernstein
{
   VectorXd points;
   MatrixXd of_values;

   explicit Bernstein(int degree) : points(degree + 1), of_values(degree + 1, degree + 1)
   {
      MatrixXd values(degree + 1, degree + 1);
      for (int k = 0; k <= degree; ++k)
      {
         const double x =
            degree ? 0.5 * (1 - std::cos(std::acos(-1.0) * k / static_cast<double>(degree)))
                   : 0.5;
         points[k] = x;
         double binomial = 1;
         for (int i = 0; i <= degree; ++i)
         {
            values(k, i) = binomial * std::pow(x, i) * std::pow(1 - x, degree - i);
            binomial *= static_cast<double>(degree - i) / (i + 1);
         }
      }
      DenseLU factors;
      factors.compute(values);
      of_values.setIdentity();
      factors.solve(of_values);
   }
};

/// Coefficients of a polynomial on the first and on the second half of its interval, one
/// polynomial a column (de Casteljau).
std::array<MatrixXd, 2> halves(MatrixXd c)
{
   const Index n = c.rows();
   std::array<MatrixXd, 2> half{c, c};
   for (Index level = 0; level < n; ++level)
   {
      half[0].row(level) = c.row(0);
      half[1].row(n - 1 - level) = c.row(n - 1 - level);
      for (Index i = 0; i + 1 < n - level; ++i) { c.row(i) = 0.5 * (c.row(i) + c.row(i + 1)); }
   }
   return half;
}

/// True if the polynomial of these Bernstein coefficients is above a level on the whole square.
bool above(const MatrixXd &c, double level, int depth = 10)
{
   if (c.minCoeff() > level) { return true; }
   const Index last = c.rows() - 1;
   const bool corners =
      c(0, 0) > level && c(last, 0) > level && c(0, last) > level && c(last, last) > level;
   if (!corners || depth == 0) { return false; }
   for (const MatrixXd &half : halves(c))
   {
      for (const MatrixXd &quarter : halves(half.transpose()))
      {
         if (!above(quarter, level, depth - 1)) { return false; }
      }
   }
   return true;
}

/// Data that elements of one shape share: the points where the determinant is sampled, and the
/// derivatives of the mapping there. The reference is the unit square. For a triangle its side
/// u = 1 is a point.
class Shape
{
public:
   explicit Shape(const mfem::FiniteElement &map)
      : bernstein_(degree(map)), by_xi_(map.GetDof(), samples()),
        by_eta_(map.GetDof(), samples())
   {
      mfem::DenseMatrix gradient(map.GetDof(), 2);
      const VectorXd &at = bernstein_.points;
      for (Index i = 0, k = 0; i < at.size(); ++i)
      {
         for (Index j = 0; j < at.size(); ++j, ++k)
         {
            mfem::IntegrationPoint ip;
            ip.Set2(at[i], triangle(map) ? at[j] * (1 - at[i]) : at[j]);
            map.CalcDShape(ip, gradient);
            for (int a = 0; a < map.GetDof(); ++a)
            {
               by_xi_(a, k) = gradient(a, 0);
               by_eta_(a, k) = gradient(a, 1);
            }
         }
      }
   }

   Fault fault(const mfem::DenseMatrix &nodes) const
   {
      const Eigen::Map<const MatrixXd> x(nodes.Data(), 2, nodes.Width());
      if (!x.allFinite()) { return Fault::none; } // for the message about the node
      const MatrixXd a = x * by_xi_, b = x * by_eta_;
      const VectorXd determinant =
         a.row(0).cwiseProduct(b.row(1)) - a.row(1).cwiseProduct(b.row(0));
      const double largest = determinant.cwiseAbs().maxCoeff();
      const double along = a.colwise().norm().maxCoeff(),
                   across = b.colwise().norm().maxCoeff();
      // Change of the determinant by the round-off of x and y.
      const auto extent = [&](Index c)
      { return a.row(c).cwiseAbs().maxCoeff() + b.row(c).cwiseAbs().maxCoeff(); };
      const double round_off = 8 * std::numeric_limits<double>::epsilon() *
                               (x.row(0).cwiseAbs().maxCoeff() * extent(1) +
                                x.row(1).cwiseAbs().maxCoeff() * extent(0));
      if (largest <= 1e-12 * along * across || largest <= round_off) { return Fault::flat; }
      const Index n = bernstein_.points.size();
      const MatrixXd c = bernstein_.of_values *
                         Eigen::Map<const MatrixXd>(determinant.data(), n, n) *
                         bernstein_.of_values.transpose();
      if (above(c, tolerance * largest)) { return Fault::none; }
      return above(-c, tolerance * largest) ? Fault::turned : Fault::folded;
   }

private:
   static bool triangle(const mfem::FiniteElement &map)
   {
      return map.GetGeomType() == mfem::Geometry::TRIANGLE;
   }
   /// Degree of the determinant in each direction, for polynomials of the map's order.
   static int degree(const mfem::FiniteElement &map)
   {
      return triangle(map) ? 2 * map.GetOrder() - 2 : 2 * map.GetOrder() - 1;
   }
   Index samples() const { return bernstein_.points.size() * bernstein_.points.size(); }

   Bernstein bernstein_;
   MatrixXd by_xi_, by_eta_; // nodes × samples
};

/// The shapes of a mesh, each made once.
class Shapes
{
public:
   explicit Shapes(mfem::Mesh &mesh) : mesh_(mesh) {}
   Fault fault(int element)
   {
      mesh_.GetElementTransformation(element, &transformation_);
      const mfem::FiniteElement &map = *transformation_.GetFE();
      auto &shape = shapes_[map.GetGeomType()];
      // For splines the shape functions depend on the element.
      if (!shape || mesh_.NURBSext) { shape = std::make_unique<Shape>(map); }
      return shape->fault(transformation_.GetPointMat());
   }

private:
   mfem::Mesh &mesh_;
   mfem::IsoparametricTransformation transformation_;
   std::array<std::unique_ptr<Shape>, mfem::Geometry::NUM_GEOMETRIES> shapes_;
};

/// The fault of an element, as numbers that ranks can exchange.
struct Place
{
   double number, attribute, x, y;
};

/// The mesh must be in space of two or three dimensions.
Place place(mfem::Mesh &mesh, int element)
{
   mfem::Vector centre(mesh.SpaceDimension());
   mesh.GetElementCenter(element, centre);
   double number = element;
#ifdef MFEM_USE_MPI
   if (const auto *shared = dynamic_cast<const mfem::ParMesh *>(&mesh))
   {
      number = static_cast<double>(shared->GetGlobalElementNum(element));
   }
#endif
   return {number, static_cast<double>(mesh.GetAttribute(element)), centre(0), centre(1)};
}

std::string name(const double *place)
{
   std::ostringstream text;
   text << "element " << static_cast<long>(place[0]) << " (attribute " << place[1]
        << ", centre (" << place[2] << ", " << place[3] << "))";
   return text.str();
}

/// Sends the list of the first rank that has one to all ranks. Empty if no rank has one. All
/// lists have this length.
std::vector<double> first_of_all(const Ranks &ranks, const std::vector<double> &here,
                                 std::size_t length)
{
   std::vector<double> all = ranks.gather(here);
   all.resize(std::min(all.size(), length));
   return all;
}

void check_plane(mfem::Mesh &mesh)
{
   const int dimension = mesh.Dimension(), space = mesh.SpaceDimension();
   if (dimension == 2 && space == 2) { return; }
   std::ostringstream which;
   if (dimension == 2 && space < 2)
   {
      // MFEM's readers drop a coordinate that is the same for all nodes.
      which << ": all of its nodes lie on one line, its elements have no thickness; nodes must "
               "differ in x and in y";
   }
   else if (dimension == 2 && mesh.GetNE() > 0)
   {
      // The element that is the farthest from the xy plane.
      int worst = 0;
      double farthest = -1, z = 0;
      mfem::Vector centre(space);
      for (int e = 0; e < mesh.GetNE(); ++e)
      {
         mesh.GetElementCenter(e, centre);
         if (!(std::abs(centre(2)) > farthest)) { continue; }
         farthest = std::abs(centre(2));
         z = centre(2);
         worst = e;
      }
      const Place at = place(mesh, worst);
      which << "; " << name(&at.number) << " is at z = " << z
            << ": turn the mesh into the xy plane and write two coordinates";
   }
   require(false, "elastic body: the mesh is of dimension ", dimension,
           " in space of dimension ", space, ", both must be 2", which.str());
}

} // namespace

std::vector<int> folded_elements(mfem::Mesh &mesh, const std::vector<int> &elements)
{
   Shapes shapes(mesh);
   std::vector<int> found;
   std::copy_if(elements.begin(), elements.end(), std::back_inserter(found),
                [&](int e) { return shapes.fault(e) != Fault::none; });
   return found;
}

void check_elements(mfem::Mesh &mesh)
{
   check_plane(mesh);
   require(
      mesh.GetNE() == 0 || mesh.GetNEdges() > 0,
      "elastic body: the mesh has no edges, from which the boundary is found: finalize it with "
      "FinalizeMesh() or generate_edges = 1");
   const Ranks ranks(mesh);
   Shapes shapes(mesh);
   std::vector<double> faulty;
   for (int e = 0; e < mesh.GetNE() && faulty.empty(); ++e)
   {
      const Fault fault = shapes.fault(e);
      if (fault == Fault::none) { continue; }
      const Place at = place(mesh, e);
      faulty = {static_cast<double>(fault), at.number, at.attribute, at.x, at.y};
   }
   faulty = first_of_all(ranks, faulty, 5);
   if (!faulty.empty())
   {
      const auto fault = static_cast<Fault>(static_cast<int>(faulty[0]));
      require(false, "elastic body: ", name(&faulty[1]), " of the mesh ",
              fault == Fault::flat
                 ? "has no area: corners of it coincide or lie on one line; take it out or "
                   "move its nodes apart"
              : fault == Fault::turned
                 ? "is turned over (the determinant of its Jacobian is negative): number its "
                   "nodes counterclockwise"
                 : "is folded over (the determinant of its Jacobian changes sign or is zero "
                   "within it): move its nodes so that it is convex and its curved edges do "
                   "not cross");
   }
   std::vector<double> pair;
   for (int face = 0; face < mesh.GetNumFaces() && pair.empty(); ++face)
   {
      int one = 0, other = 0, info_one = 0, info_other = 0, hanging = 0;
      mesh.GetFaceElements(face, &one, &other);
      mesh.GetFaceInfos(face, &info_one, &info_other, &hanging);
      if (other < 0 || hanging >= 0) { continue; }
      const auto start = [&](int element, int info)
      {
         mfem::Array<int> vertices;
         mesh.GetElementVertices(element, vertices);
         return vertices[mesh.GetElement(element)->GetEdgeVertices(info / 64)[0]];
      };
      // Two counterclockwise elements go along their common edge in opposite directions.
      if (start(one, info_one) != start(other, info_other)) { continue; }
      const Place first = place(mesh, one), second = place(mesh, other);
      pair = {first.number,  first.attribute,  first.x,  first.y,
              second.number, second.attribute, second.x, second.y};
   }
   pair = first_of_all(ranks, pair, 8);
   if (!pair.empty())
   {
      require(false, "elastic body: ", name(pair.data()), " and ", name(&pair[4]),
              " of the mesh lie on the same side of the edge that they share: the mesh is "
              "folded over there, move the nodes that were drawn across");
   }
}

} // namespace cattaneo
