#include <algorithm>
#include <cattaneo/halfplane/heights.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/whole_file.hpp>
#include <cattaneo/words.hpp>
#include <cmath>
#include <limits>
#include <map>

namespace cattaneo
{

using Eigen::Index;

namespace
{

/// The header of a file: values by their keys.
class HeightsHeader
{
public:
   HeightsHeader(std::string where, const std::string &text) : where_(std::move(where))
   {
      for (const std::string &line : split(text, "\n"))
      {
         const std::size_t equals = line.find('=');
         if (equals == std::string::npos) { continue; }
         const std::vector<std::string> key = split(line.substr(0, equals), "="),
                                        value = split(line.substr(equals + 1), "=");
         if (!key.empty()) { values_[key.front()] = value.empty() ? "" : value.front(); }
      }
   }

   double length(const char *key) const
   {
      const auto found = values_.find(key);
      require(found != values_.end(), where_, "the header has no ", key);
      const double value = number(where_ + key, found->second);
      require(value > 0, where_, key, " is ", value, ", must be positive");
      return value;
   }
   Index count(const char *key) const
   {
      const double value = length(key);
      require(value == std::floor(value) && value >= 2 && value < 1e6, where_, key, " is ",
              value, ", must be a whole number from 2 to a million");
      return static_cast<Index>(value);
   }

private:
   std::string where_;
   std::map<std::string, std::string> values_;
};

} // namespace

Eigen::VectorXd Heights::at(const Eigen::MatrixX2d &points) const
{
   require(z.rows() > 1 && z.cols() > 1, "heights: the grid is ", z.rows(), "×", z.cols(),
           " points, must be two or more along x and y");
   require(step.allFinite() && step.minCoeff() > 0, "heights: the steps of the grid are ", step,
           ", must be positive");
   const Eigen::Array2d most(static_cast<double>(z.rows() - 1),
                             static_cast<double>(z.cols() - 1));
   Eigen::VectorXd result(points.rows());
   for (Index k = 0; k < points.rows(); ++k)
   {
      const Eigen::Vector2d point = points.row(k);
      const Eigen::Array2d place = point.array() / step.array() + most / 2;
      // A point on the rim belongs to the grid in spite of rounding.
      require((place >= -1e-9).all() && (place <= most + 1e-9).all(), "heights: the point ",
              point, " lies outside of the measured part, |x| <= ", most[0] * step[0] / 2,
              ", |y| <= ", most[1] * step[1] / 2);
      const Eigen::Array2d cell = place.floor().max(0).min(most - 1), share = place - cell;
      const auto i = static_cast<Index>(cell[0]), j = static_cast<Index>(cell[1]);
      result[k] = (1 - share[1]) * ((1 - share[0]) * z(i, j) + share[0] * z(i + 1, j)) +
                  share[1] * ((1 - share[0]) * z(i, j + 1) + share[0] * z(i + 1, j + 1));
      require(std::isfinite(result[k]), "heights: beside the point ", point,
              " the surface was not measured: points must lie within the measured part");
   }
   return result;
}

Heights read_heights(const std::string &file, double unit)
{
   require_positive("heights: unit", unit);
   const std::string text = read_whole(file), where = "file '" + file + "': ";
   const std::vector<std::string> first = split(text.substr(0, text.find('\n')), "\r\n");
   require(
      !first.empty() && (first[0] == "aISO-1.0" || first[0] == "aBCR-1.0"), where,
      "its first line must be aISO-1.0 or aBCR-1.0, as in a text file of surface data (SDF)");
   // Header, data and trailer are separated by stars.
   const std::size_t star = text.find('*');
   require(star != std::string::npos, where, "a line with a * must follow the header");
   const HeightsHeader header(where, text.substr(0, star));
   Heights heights;
   heights.step[0] = header.length("Xscale") / unit;
   heights.step[1] = header.length("Yscale") / unit;
   heights.z.resize(header.count("NumPoints"), header.count("NumProfiles"));
   const double scale = header.length("Zscale") / unit;
   const std::size_t end = std::min(text.find('*', star + 1), text.size());
   const std::vector<std::string> words =
      split(text.substr(star + 1, end - star - 1), " \t\r\n");
   require(static_cast<Index>(words.size()) == heights.z.size(), where, "there are ",
           words.size(), " heights, must be NumPoints × NumProfiles = ", heights.z.size());
   for (Index k = 0; k < heights.z.size(); ++k)
   {
      const std::string &word = words[static_cast<std::size_t>(k)];
      heights.z.data()[k] = word == "BAD" ? std::numeric_limits<double>::quiet_NaN()
                                          : scale * number(where + "height", word);
   }
   return heights;
}

} // namespace cattaneo
