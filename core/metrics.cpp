// metrics.cpp
