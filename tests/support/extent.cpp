#include "extent.hpp"

namespace cattaneo_test
{

Extent extent()
{
   const char *wish = std::getenv("CATTANEO_STRESS");
   const std::string word = wish ? wish : "";
   return word == "full" ? Extent::full : word == "short" ? Extent::brief : Extent::usual;
}

int cases(int usual, int full)
{
   return extent() == Extent::full ? full : extent() == Extent::brief ? usual / 8 : usual;
}

} // namespace cattaneo_test
