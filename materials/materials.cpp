// materials.cpp
