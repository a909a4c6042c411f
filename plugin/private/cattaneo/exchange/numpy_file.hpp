#pragma once

#include <Eigen/Dense>
#include <map>
#include <string>
#include <vector>

namespace cattaneo
{

/// An array of NumPy, with numbers of any kind that doubles can hold.
struct NumpyArray
{
   std::vector<Eigen::Index> shape;
   bool by_columns = false;
   std::vector<double> values;

   /// InputError, with `name`, unless it has two dimensions.
   Eigen::MatrixXd matrix(const std::string &name) const;
};

/// Reads the `content` of an .npy file. InputError, with `name`, if it is not such a file, or
/// has other numbers than little-endian float32, float64, int32 and int64.
NumpyArray numpy_array(const std::string &content, const std::string &name);

/// The files in a zip archive by name, stored without compression as np.savez does; InputError
/// for any other archive.
std::map<std::string, std::string> stored_files(const std::string &archive,
                                                const std::string &name);

} // namespace cattaneo
