// Bodies that a real CalculiX (the program ccx, Debian's calculix-ccx) assembles from a mesh of
// MFEM's, against MFEM's own: a punch on a block and a lap joint, of 4-node quadrilaterals and
// of straight 6-node triangles, on which both have the same elements.

#include <cattaneo/contact/assemble.hpp>
#include <cattaneo/contact/boundary_line.hpp>
#include <cattaneo/contact/interfaces_of_bodies.hpp>
#include <cattaneo/exchange/read_stiffness.hpp>
#include <cattaneo/friction/march.hpp>
#include <cattaneo/mesh/graded_mesh.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>

namespace
{

using namespace cattaneo;

constexpr int bottom = 1, right = 2, top = 3, left = 4;
const Material steel{210000.0, 0.3};

/// A rectangle with its lower left corner at (x, y).
struct Block
{
   double x, y, wide, high;
   int across, up;
};

/// Two bodies of MFEM and the deck of both. Node n of body b is 1000 b + n + 1 there.
struct Pair
{
   int order;
   std::vector<mfem::Mesh> meshes;
   std::vector<std::unique_ptr<ElasticBody>> bodies;

   Pair(const std::vector<Block> &blocks, int order_) : order(order_)
   {
      const auto type = order == 1 ? mfem::Element::QUADRILATERAL : mfem::Element::TRIANGLE;
      for (const Block &block : blocks)
      {
         meshes.push_back(mfem::Mesh::MakeCartesian2D(block.across, block.up, type, true,
                                                      block.wide, block.high));
         meshes.back().Transform(
            [&](const mfem::Vector &at, mfem::Vector &to)
            {
               // Elements of all shapes, on straight sides.
               to = at;
               const double s = at(0) / block.wide, t = at(1) / block.high;
               to(0) = block.x + block.wide * (s + 0.1 * std::sin(2 * M_PI * s));
               to(1) = block.y + block.high * (t + 0.1 * std::sin(2 * M_PI * s) * t * (1 - t));
            });
      }
      for (mfem::Mesh &mesh : meshes)
      {
         bodies.push_back(std::make_unique<ElasticBody>(mesh, order, steel));
      }
   }
   int number(std::size_t body, int dof) const
   {
      return 1000 * static_cast<int>(body) + dof + 1;
   }
   static std::string set(std::size_t body, int side)
   {
      return "SIDE" + std::to_string(body) + std::to_string(side);
   }

   /// `supports`: lines of *BOUNDARY.
   void write_deck(const std::string &file, const std::string &supports) const
   {
      std::ofstream out(file);
      out.precision(17);
      for (std::size_t b = 0; b < bodies.size(); ++b)
      {
         const mfem::FiniteElementSpace &space = bodies[b]->space();
         const mfem::DenseMatrix &x = bodies[b]->node_coordinates();
         mfem::Array<int> dofs;
         out << "*NODE\n";
         for (int n = 0; n < x.Width(); ++n)
         {
            out << number(b, n) << ", " << x(0, n) << ", " << x(1, n) << "\n";
         }
         out << "*ELEMENT, TYPE=" << (order == 1 ? "CPE4" : "CPE6") << ", ELSET=BODY" << b
             << "\n";
         for (int e = 0; e < space.GetNE(); ++e)
         {
            out << number(b, e);
            space.GetElementDofs(e, dofs);
            for (int dof : dofs) { out << ", " << number(b, dof); }
            out << "\n";
         }
         for (int side : {bottom, right, top, left})
         {
            out << "*NSET, NSET=" << set(b, side) << "\n";
            for (int e = 0; e < space.GetNBE(); ++e)
            {
               if (space.GetBdrAttribute(e) != side) { continue; }
               space.GetBdrElementDofs(e, dofs);
               for (int dof : dofs) { out << number(b, dof) << ",\n"; }
            }
         }
      }
      out << "*MATERIAL, NAME=STEEL\n*ELASTIC\n210000., 0.3\n*DENSITY\n7.8e-9\n";
      for (std::size_t b = 0; b < bodies.size(); ++b)
      {
         out << "*SOLID SECTION, ELSET=BODY" << b << ", MATERIAL=STEEL\n";
      }
      if (!supports.empty()) { out << "*BOUNDARY\n" << supports; }
      out << "*STEP\n*FREQUENCY, SOLVER=MATRIXSTORAGE\n*END STEP\n";
   }
};

/// Bodies of CalculiX's matrix, by name.
std::vector<NodalStiffness> assembled_by_calculix(const Pair &pair, const std::string &supports)
{
   pair.write_deck("pair.inp", supports);
   EXPECT_EQ(std::system("ccx pair > pair.log 2>&1"), 0) << "see pair.log";
   std::vector<NodalStiffness> parts = read_stiffness("pair.sti").parts();
   EXPECT_EQ(parts.size(), 2);
   EXPECT_EQ(parts[0].name, "BODY0");
   EXPECT_EQ(parts[1].name, "BODY1");
   return parts;
}

/// The lower one's top on the upper one's bottom.
Reduction reduced(const std::vector<NodalStiffness> &parts)
{
   const ContactLine below = parts[0].contact_line(parts[0].nodes_of(Pair::set(0, top))),
                     above = parts[1].contact_line(parts[1].nodes_of(Pair::set(1, bottom)));
   return reduce({condense(parts[0].body(), below), condense(parts[1].body(), above)},
                 {{"contact", {0, below}, {1, above}}});
}

Reduction reduced(const Pair &pair)
{
   return reduce({{"lower", pair.bodies[0].get()}, {"upper", pair.bodies[1].get()}},
                 {{"contact", {0, top}, {1, bottom}}});
}

void expect_same_march(Reduction mfem, Reduction calculix, double shear)
{
   std::vector<ContactState> states;
   std::vector<Eigen::MatrixXd> stiffness;
   for (Reduction *each : {&mfem, &calculix})
   {
      ReducedProblem &problem = each->problem;
      set_friction(problem, 0.4);
      states.push_back(ContactState::virgin(problem));
      const LoadHistory history = LoadHistory::through(
         problem, {{}, {{"P", 1}}, {{"P", 1}, {"Q", shear}}, {{"P", 1}, {"Q", -0.5 * shear}}});
      ASSERT_EQ(march(problem, history, states.back()).status, FrictionStatus::converged);
      stiffness.push_back(problem.K);
   }
   const ContactState &a = states[0], &b = states[1];
   ASSERT_EQ(a.p.size(), b.p.size());
   const double force = a.p.cwiseAbs().maxCoeff(), way = a.v.cwiseAbs().maxCoeff();
   ASSERT_GT(force, 0);
   ASSERT_GT(way, 0);
   EXPECT_EQ(a.status, b.status);
   EXPECT_GT(std::count(a.status.begin(), a.status.end(), NodeState::stick), 0);
   EXPECT_LT(std::count(a.status.begin(), a.status.end(), NodeState::stick), a.p.size());
   EXPECT_LT((a.p - b.p).lpNorm<Eigen::Infinity>(), 1e-9 * force);
   EXPECT_LT((a.q - b.q).lpNorm<Eigen::Infinity>(), 1e-9 * force);
   EXPECT_LT((a.v - b.v).lpNorm<Eigen::Infinity>(), 1e-9 * way);
   EXPECT_LT((a.w - b.w).lpNorm<Eigen::Infinity>(), 1e-9 * way);
   const double digits =
      (stiffness[0] - stiffness[1]).cwiseAbs().maxCoeff() / stiffness[0].cwiseAbs().maxCoeff();
   EXPECT_LT(digits, 1e-11);
   std::cout << a.p.size() << " nodes: reduced stiffness to " << digits << ", forces to "
             << (a.p - b.p).lpNorm<Eigen::Infinity>() / force << "\n";
}

class Calculix : public testing::Test
{
protected:
   Calculix() : before_(std::filesystem::current_path())
   {
      std::filesystem::current_path(testing::TempDir());
   }
   ~Calculix() override { std::filesystem::current_path(before_); }
   void SetUp() override
   {
      if (std::system("command -v ccx > ccx.path") != 0)
      {
         GTEST_SKIP() << "there is no CalculiX, the program ccx (Debian: calculix-ccx)";
      }
   }

private:
   std::filesystem::path before_;
};

/// Cases that are run with elements of each order.
class CalculixElements : public Calculix, public testing::WithParamInterface<int>
{
};

TEST_P(CalculixElements, PunchOnABlock)
{
   Pair pair({{-2, -2, 4, 2, 20, 8}, {-1, 0, 2, 1.5, 8, 5}}, GetParam());
   std::vector<NodalStiffness> parts =
      assembled_by_calculix(pair, Pair::set(0, bottom) + ", 1, 2\n");
   for (int c : {0, 1}) { pair.bodies[0]->fix(bottom, c); }
   pair.bodies[1]->add_traction("P", top, 0.0, -100.0);
   pair.bodies[1]->add_traction("Q", top, 100.0, 0.0);
   NodalStiffness &punch = parts[1];
   punch.add_traction("P", punch.nodes_of(Pair::set(1, top)), {0, -100});
   punch.add_traction("Q", punch.nodes_of(Pair::set(1, top)), {100, 0});
   expect_same_march(reduced(pair), reduced(parts), 0.37);
}

TEST_P(CalculixElements, LapJoint)
{
   Pair pair({{-1.5, -0.5, 3, 0.5, 17, 4}, {0, 0, 3, 0.5, 12, 3}}, GetParam());
   std::vector<NodalStiffness> parts =
      assembled_by_calculix(pair, Pair::set(0, bottom) + ", 2, 2\n");
   NodalStiffness &lower = parts[0], &upper = parts[1];
   // The face ends at the support on the left, whose nodes the matrix must have for that.
   pair.bodies[0]->fix(bottom, 1);
   pair.bodies[0]->fix(left, 0);
   lower.fix(lower.nodes_of(Pair::set(0, left)), 1);
   pair.bodies[1]->add_displacement("P", top, 1, -1e-3);
   pair.bodies[1]->add_displacement("Q", top, 0, 1e-3);
   upper.add_displacement("P", upper.nodes_of(Pair::set(1, top)), 2, -1e-3);
   upper.add_displacement("Q", upper.nodes_of(Pair::set(1, top)), 1, 1e-3);
   expect_same_march(reduced(pair), reduced(parts), 0.9);
}

/// meshes/calculix has what CalculiX 2.20 made of the deck there.
TEST_F(Calculix, WritesWhatIsShipped)
{
   const std::string shipped = std::string(CATTANEO_SOURCE_DIR) + "/meshes/calculix/laps";
   std::filesystem::copy_file(shipped + ".inp", "laps.inp",
                              std::filesystem::copy_options::overwrite_existing);
   ASSERT_EQ(std::system("ccx laps > laps.log 2>&1"), 0);
   const NodalStiffness old = read_stiffness(shipped + ".sti"),
                        now = read_stiffness("laps.sti");
   ASSERT_EQ(now.dofs.size(), old.dofs.size());
   std::map<NodeDof, int> row;
   for (std::size_t k = 0; k < now.dofs.size(); ++k) { row[now.dofs[k]] = static_cast<int>(k); }
   std::vector<int> order;
   for (const NodeDof &dof : old.dofs) { order.push_back(row.at(dof)); }
   const Eigen::MatrixXd K(old.K), again = Eigen::MatrixXd(now.K)(order, order);
   EXPECT_LT((K - again).cwiseAbs().maxCoeff(), 1e-12 * K.cwiseAbs().maxCoeff());
}

INSTANTIATE_TEST_SUITE_P(Of, CalculixElements, testing::Values(1, 2),
                         [](const auto &info)
                         { return info.param == 1 ? "FourNodes" : "SixNodes"; });

/// As a program with 14 digits writes it.
AssembledBody rounded(AssembledBody body)
{
   Eigen::SparseMatrix<double, Eigen::RowMajor> K = body.K.view();
   for (int k = 0; k < K.nonZeros(); ++k)
   {
      char text[32];
      std::snprintf(text, sizeof text, "%.13e", K.valuePtr()[k]);
      K.valuePtr()[k] = std::atof(text);
   }
   body.K = SharedMatrix(K);
   return body;
}

TEST(FourteenDigits, CostLargeFreeBodiesSome)
{
   std::vector<double> contact;
   for (int k = 0; k <= 40; ++k) { contact.push_back(-1 + 0.05 * k); }
   for (const bool held : {true, false})
   {
      for (const double domain : {10.0, 100.0, 1e3, 1e4})
      {
         mfem::Mesh mesh = half_plane_mesh(contact, graded(0, 1, 0.05, 1.25),
                                           ring_scales(1.0, domain, 0.05, 1.25));
         ElasticBody body(mesh, 1, steel);
         const ContactLine line = contact_line(body, 1);
         AssembledBody exact = assembled(body);
         if (held)
         {
            const BoundaryPart far({3, 4});
            body.fix(far, 0);
            body.fix(far, 1);
            exact = assembled(body);
         }
         const Eigen::MatrixXd S = condense(exact, line).S;
         const CondensedBody other = condense(rounded(exact), line);
         const double error = (other.S - S).cwiseAbs().maxCoeff() / S.cwiseAbs().maxCoeff();
         EXPECT_EQ(other.free_motions.cols(), held ? 0 : 3);
         // What far entries do to a rotation grows with the square of their distance.
         EXPECT_LT(error, held ? 1e-12 : 1e-13 * std::max(100.0, domain * domain));
         std::cout << (held ? "held" : "free") << ", domain " << domain << ": " << error
                   << "\n";
      }
   }
}

} // namespace
