// table.cpp
