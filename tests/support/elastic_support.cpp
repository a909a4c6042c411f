#include "elastic_support.hpp"

namespace support
{

MatrixXd dense(const mfem::SparseMatrix &K)
{
   MatrixXd D = MatrixXd::Zero(K.Height(), K.Width());
   for (int i = 0; i < K.Height(); ++i)
   {
      for (int k = K.GetI()[i]; k < K.GetI()[i + 1]; ++k)
      {
         D(i, K.GetJ()[k]) += K.GetData()[k];
      }
   }
   return D;
}

std::vector<double> uniform(double from, double to, int n)
{
   std::vector<double> x;
   for (int i = 0; i <= n; ++i) { x.push_back(i == n ? to : from + (to - from) * i / n); }
   return x;
}

mfem::Mesh block(const std::string &kind, int nx, int ny)
{
   using mfem::Mesh;
   const auto shape =
      kind == "triangles" ? mfem::Element::TRIANGLE : mfem::Element::QUADRILATERAL;
   Mesh mesh = Mesh::MakeCartesian2D(nx, ny, shape, true, 2.0, 1.0, false);
   if (kind == "nonconforming" || kind == "nonconforming triangles")
   {
      if (kind != "nonconforming")
      {
         mesh = Mesh::MakeCartesian2D(nx, ny, mfem::Element::TRIANGLE, true, 2.0, 1.0, false);
      }
      mesh.EnsureNCMesh(true);
      for (int seed : {1, 5})
      {
         mfem::Array<int> some;
         for (int e = 0; e < mesh.GetNE(); e += 3 + seed) { some.Append(e); }
         mesh.GeneralRefinement(some, 1);
      }
   }
   if (kind == "curved")
   {
      mesh.SetCurvature(3);
      mesh.Transform(
         [](const mfem::Vector &x, mfem::Vector &y)
         {
            y.SetSize(2);
            y(0) = x(0) + 0.05 * std::sin(2 * x(1));
            y(1) = x(1) + 0.1 * std::sin(2 * x(0));
         });
   }
   return mesh;
}

void rotate(mfem::Mesh &mesh, double angle)
{
   const double c = std::cos(angle), s = std::sin(angle);
   for (int v = 0; v < mesh.GetNV(); ++v)
   {
      double *x = mesh.GetVertex(v);
      const double old[2] = {x[0], x[1]};
      x[0] = c * old[0] - s * old[1];
      x[1] = s * old[0] + c * old[1];
   }
}

Split::Split(const cattaneo::ElasticBody &body, const cattaneo::ContactLine &line)
   : K(dense(body.stiffness()))
{
   const auto n = line.size();
   std::vector<int> kind(K.rows(), 0);
   for (int dof : body.essential_dofs())
   {
      D.push_back(dof);
      kind[dof] = 1;
   }
   for (int c = 0; c < 2; ++c)
   {
      for (const auto &node : line.nodes)
      {
         C.push_back(node.dofs[c]);
         kind[node.dofs[c]] = 2;
      }
   }
   for (int dof = 0; dof < K.rows(); ++dof)
   {
      if (kind[dof] == 0) { I.push_back(dof); }
   }
   R = MatrixXd::Zero(2 * n, 2 * n);
   for (Eigen::Index i = 0; i < n; ++i)
   {
      R(i, i) = line.nodes[i].tangent[0];
      R(i, n + i) = line.nodes[i].tangent[1];
      R(n + i, i) = line.nodes[i].normal()[0];
      R(n + i, n + i) = line.nodes[i].normal()[1];
   }
}

MatrixXd Split::block(const std::vector<int> &rows, const std::vector<int> &cols) const
{
   return K(rows, cols);
}

} // namespace support
