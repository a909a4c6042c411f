#pragma once

#include <Eigen/Dense>
#include <Eigen/Sparse>
#include <functional>
#include <vector>

namespace cattaneo
{

/** An element of order k of a straight surface. Its functions φ are the polynomials of degree k
    in a parameter 0 <= t <= 1 that are 1 at one of the Gauss–Lobatto points and 0 at the
    others. The same functions interpolate its place x(t) from the places of its nodes, which
    increase along the element but need not be at the Gauss–Lobatto points. */
struct SurfaceElement
{
   std::vector<Eigen::Index> unknowns; ///< number of each node
   Eigen::VectorXd x;                  ///< place of each node along the surface, increasing

   Eigen::Index order() const { return x.size() - 1; }
   double size() const { return x[order()] - x[0]; }
};

/// Points of an element, and its functions there.
struct SurfacePoints
{
   Eigen::VectorXd x;   ///< places from the first node of the element on
   Eigen::VectorXd dx;  ///< dx/dt
   Eigen::MatrixXd phi; ///< functions × points
};

/// The elements of a straight surface on which displacements and tractions are interpolated.
class SurfaceTrace
{
public:
   /// InputError unless the elements are of orders 1 to 8, x(t) increases on each, and they
   /// follow each other without overlap.
   SurfaceTrace(Eigen::Index unknowns, std::vector<SurfaceElement> elements);

   Eigen::Index unknowns() const { return unknowns_; }
   const std::vector<SurfaceElement> &elements() const { return elements_; }
   /// The mirror image on the other side of the origin: x becomes -x.
   SurfaceTrace mirrored() const;

   /// The points of an element at the parameters t.
   SurfacePoints points(const SurfaceElement &element, const Eigen::VectorXd &t) const;

   using Weight = std::function<double(double x)>;
   /// ∫ w φ_i dx
   Eigen::VectorXd integral(const Weight &w) const;
   /// ∫ w φ_i φ_j dx
   Eigen::SparseMatrix<double> mass(const Weight &w) const;
   /// ∫∫ f(x) φ_i(x) g(s) φ_j(s) ds dx over s < x
   Eigen::MatrixXd ordered_integral(const Weight &f, const Weight &g) const;

private:
   Eigen::Index unknowns_;
   std::vector<SurfaceElement> elements_;
};

/// The mass matrix of several components, which are not coupled, for the unknowns in `kept`:
/// number k times its size + i is row i of component k.
Eigen::SparseMatrix<double> kept_of(const Eigen::SparseMatrix<double> &mass,
                                    const std::vector<int> &kept);

} // namespace cattaneo
