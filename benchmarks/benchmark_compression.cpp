//  benchmark_compression: what hierarchical compression of the contact stiffness would buy
//
//  The reduced stiffness of real scenes, and its inverse (with unit springs on motions that
//  nothing resists), unknowns ordered along the contact, those of a node together, scaled to a
//  diagonal of ones. Numerical ranks, singular values above 1e-8 and 1e-12, of the blocks of a
//  binary tree: beside the diagonal (weak admissibility: HODLR, HSS) and one block apart
//  (strong: H²), by the block's number of nodes. With the ranks as a straight line in the
//  logarithm of that number: memory, and operations of one factorisation, of 10⁴ and 10⁵ nodes,
//  dense and as HODLR with its factor, and what an active-set method needs of either.

#include "common/disc_scene.hpp"
#include "common/miniapp.hpp"
#include "common/options.hpp"
#include "common/punch.hpp"
#include "common/receding.hpp"

#include <cattaneo/algebra/dense_cholesky.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <map>

using namespace cattaneo;
using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace
{

constexpr double accuracies[] = {1e-8, 1e-12};
/// Size of the tree's leaves, in unknowns; smaller blocks are not worth their factors.
constexpr double leaf = 64;

/// Unknowns node by node along the contact, scaled to a diagonal of ones.
MatrixXd ordered(const ReducedProblem &problem, const MatrixXd &K)
{
   const Index n = problem.nodes(), components = K.rows() / n;
   std::vector<int> order(K.rows());
   for (Index i = 0; i < n; ++i)
   {
      for (Index c = 0; c < components; ++c)
      {
         order[i * components + c] = static_cast<int>(c * n + i);
      }
   }
   const VectorXd scale = K.diagonal().cwiseSqrt().cwiseInverse();
   return (scale.asDiagonal() * K * scale.asDiagonal())(order, order);
}

/// @param rate operations a second of its factorisation
MatrixXd compliance(const ReducedProblem &problem, double &rate)
{
   const MatrixXd &Z = problem.rigid_motions;
   MatrixXd held = problem.K + problem.K.diagonal().mean() * Z * Z.transpose();
   DenseCholesky factor;
   const std::clock_t began = std::clock();
   require(factor.compute(std::move(held)), "the reduced stiffness is not positive definite");
   rate = std::pow(double(Z.rows()), 3) / 3 * CLOCKS_PER_SEC / double(std::clock() - began);
   return factor.inverse();
}

/// Singular values of a block down to the last accuracy, from its action on random vectors.
ArrayXd singular_values(const MatrixXd &block)
{
   for (Index columns = 64;; columns *= 2)
   {
      const Index all = std::min(block.rows(), block.cols());
      MatrixXd Q = block;
      if (columns < all)
      {
         std::srand(1); // Eigen's random numbers are those of the C library
         const MatrixXd image = block * MatrixXd::Random(block.cols(), columns);
         Q = Eigen::HouseholderQR<MatrixXd>(image).householderQ() *
             MatrixXd::Identity(block.rows(), columns);
         Q = (Q.transpose() * block).eval();
      }
      const ArrayXd values = Eigen::BDCSVD<MatrixXd>(Q).singularValues();
      if (columns >= all || values[columns - 9] < 0.1 * accuracies[1]) { return values; }
   }
}

/// Largest ranks of a tree's blocks of one size, for each accuracy, beside the diagonal and
/// away from it; -1 if there is no such block.
struct BlockRanks
{
   long beside[2] = {-1, -1}, apart[2] = {-1, -1};
};

/// By nodes of a block.
std::map<Index, BlockRanks> ranks_of(const MatrixXd &M, Index nodes)
{
   std::map<Index, BlockRanks> all;
   const Index components = M.rows() / nodes;
   for (Index m = nodes / 2; m * components >= leaf; m /= 2)
   {
      const auto most = [&](long(&ranks)[2], Index row, Index column)
      {
         const Index size = m * components;
         if (std::max(row, column) * size + size > M.rows()) { return; }
         const ArrayXd values = singular_values(M.block(row * size, column * size, size, size));
         for (int a : {0, 1})
         {
            ranks[a] = std::max(ranks[a], (values > accuracies[a]).count());
         }
      };
      // The first, the last and the middle ones: ends of the contact, and its inside.
      const Index blocks = nodes / m;
      BlockRanks &found = all[m];
      for (Index k : {Index(0), (blocks - 2) / 4 * 2, (blocks - 2) / 2 * 2})
      {
         most(found.beside, k, k + 1);
         most(found.apart, k, k + 2);
      }
   }
   return all;
}

/// A rank as a straight line in log2 of a block's nodes.
struct Line
{
   double at_one, slope;

   static Line through(const std::map<Index, BlockRanks> &ranks, long (BlockRanks::*kind)[2],
                       int a)
   {
      double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
      for (const auto &[nodes, found] : ranks)
      {
         const double x = std::log2(double(nodes)), y = double((found.*kind)[a]);
         n += 1, sx += x, sy += y, sxx += x * x, sxy += x * y;
      }
      const double slope = (n * sxy - sx * sy) / (n * sxx - sx * sx);
      return {(sy - slope * sx) / n, slope};
   }
   double operator()(double nodes) const { return at_one + slope * std::log2(nodes); }
};

/// What a symmetric HODLR matrix of so many unknowns and its factor take.
struct Hierarchical
{
   double entries = 0, operations = 0; ///< of the matrix; of its factorisation
};

/** Each block U Vᵀ beside the diagonal is kept once. The factorisation solves with the factors
    below a level for the columns U of that level, two operations for each entry that they have
    and column, twice. */
Hierarchical hodlr(double nodes, double components, const Line &rank)
{
   const double unknowns = nodes * components;
   double below = nodes;
   while (below * components > leaf) { below /= 2; }
   Hierarchical all{unknowns * below * components, unknowns * std::pow(below * components, 2)};
   for (double m = below; m < 0.75 * nodes; m *= 2)
   {
      all.operations += 4 * rank(m) * all.entries;
      all.entries += unknowns * rank(m);
   }
   return all;
}

miniapp::Scene scene(const std::string &name, int nodes)
{
   if (name == "punch")
   {
      miniapp::PunchOptions options;
      options.half_plane = true;
      options.nodes = nodes;
      return miniapp::make_punch(options);
   }
   if (name == "strip")
   {
      miniapp::RecedingOptions options; // 409 nodes
      options.spacing *= 409.0 / nodes;
      options.corner *= 409.0 / nodes;
      return miniapp::make_receding(options);
   }
   miniapp::DiscOptions options; // 250 nodes
   options.spacing *= 250.0 / nodes;
   return miniapp::make_disc(options);
}

void print_row(const char *of, const std::map<Index, BlockRanks> &ranks)
{
   const auto text = [](long rank) { return rank < 0 ? "-" : std::to_string(rank); };
   for (const auto &[nodes, found] : ranks)
   {
      std::printf("%-24s %8ld | %7ld %7ld | %7s %7s\n", of, long(nodes), found.beside[0],
                  found.beside[1], text(found.apart[0]).c_str(), text(found.apart[1]).c_str());
   }
   std::fflush(stdout);
}

} // namespace

int main(int argc, char *argv[])
{
   return miniapp::run(
      [&]
      {
         int nodes = 2001;
         miniapp::Options args("benchmarks/benchmark_compression.cpp", argc, argv);
         args.add(&nodes, "nodes", "Contact nodes of the scenes, about.",
                  miniapp::at_least(201));
         args.parse();
         nodes += 1 - nodes % 2; // quadratic elements

         std::printf("\nLargest ranks of blocks\n%-24s %8s | %7s %7s | %7s %7s\n", "", "nodes",
                     "beside", "beside", "apart", "apart");
         std::printf("%-24s %8s | %7.0e %7.0e | %7.0e %7.0e\n", "", "of block", accuracies[0],
                     accuracies[1], accuracies[0], accuracies[1]);
         std::map<Index, BlockRanks> most;
         double rate = 0;
         for (const std::string name : {"punch", "strip", "disc"})
         {
            const miniapp::Scene made = scene(name, nodes);
            const ReducedProblem &problem = made.problem();
            for (const bool inverse : {false, true})
            {
               const MatrixXd M =
                  ordered(problem, inverse ? compliance(problem, rate) : problem.K);
               const auto ranks = ranks_of(M, problem.nodes());
               const std::string of = name + (inverse ? ", compliance" : ", stiffness") + " " +
                                      std::to_string(problem.nodes());
               print_row(of.c_str(), ranks);
               // Sizes of blocks differ a little from scene to scene.
               for (const auto &[m, found] : ranks)
               {
                  const auto level = static_cast<Index>(
                     std::lround(std::log2(double(problem.nodes()) / double(m))));
                  BlockRanks &all = most[(nodes - 1) >> level];
                  for (int a : {0, 1})
                  {
                     all.beside[a] = std::max(all.beside[a], found.beside[a]);
                     all.apart[a] = std::max(all.apart[a], found.apart[a]);
                  }
               }
            }
         }
         print_row("largest of all", most);

         std::printf(
            "\nTwo unknowns a node, with the largest ranks as lines in log2 of the "
            "nodes; a dense factor is made\nat %.0f GFLOP/s here\n%9s %-10s %9s %9s %13s "
            "%15s\n",
            1e-9 * rate, "nodes", "", "rank, top", "GB", "factor, GFLOP", "solution, GFLOP");
         for (const double n : {1e4, 1e5})
         {
            const double N = 2 * n;
            std::printf("%9.0f %-10s %9s %9.2f %13.3g %15.2g\n", n, "dense", "", 8e-9 * N * N,
                        1e-9 * N * N * N / 3, 2e-9 * N * N);
            for (int a : {0, 1})
            {
               const Line rank = Line::through(most, &BlockRanks::beside, a);
               const Hierarchical all = hodlr(n, 2, rank);
               std::printf("%9.0f HODLR%5.0e %9.0f %9.2f %13.3g %15.2g\n", n, accuracies[a],
                           rank(n / 2), 8e-9 * all.entries, 1e-9 * all.operations,
                           4e-9 * all.entries);
            }
         }
         return 0;
      });
}
