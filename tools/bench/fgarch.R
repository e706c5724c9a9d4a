# Seconds that fGarch takes for what arma_garch_bench.cpp times: estimate and sandwich of an ARMA(3,2)-GARCH(1,1).
#
#   Rscript fgarch.R [SAMPLES...]
#
# Prints samples, seconds, and nlminb's convergence code, a line for each; without arguments for 5000 and 20 000 samples.
suppressMessages(library(fGarch))
samples <- as.integer(commandArgs(trailingOnly = TRUE))
if (length(samples) == 0) samples <- c(5000L, 20000L)

simulated <- function(n) {
  before <- 1000
  all <- n + before
  z <- rnorm(all)
  e <- y <- numeric(all)
  s2 <- 1
  for (t in 4:all) {
    s2 <- 0.05 + 0.08 * e[t - 1]^2 + 0.87 * s2
    e[t] <- sqrt(s2) * z[t]
    y[t] <- 0.02 + sum(c(0.9, -0.55, 0.3) * y[t - 1:3]) + sum(c(0.6, 0.25) * e[t - 1:2]) + e[t]
  }
  y[-(1:before)]
}
for (n in samples) {
  set.seed(1)
  y <- simulated(n)
  seconds <- system.time(found <- suppressWarnings(garchFit(~ arma(3, 2) + garch(1, 1), data = y, cond.dist = "QMLE",
                                                            algorithm = "nlminb", trace = FALSE)))[["elapsed"]]
  cat(n, sprintf("%.2f", seconds), found@fit$convergence, "\n")
}
