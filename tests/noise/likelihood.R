# The likelihood of a static record and its maximum by R's own state-space code (stats::KalmanRun, optim): what
# r_likelihood_test.cpp compares with.
#
#   Rscript likelihood.R RECORD MODEL PARAMETER...
#
# Prints the log-likelihood at the parameters, its maximum, and the parameters there. Of a mean of zero, one sample a second.
arguments <- commandArgs(trailingOnly = TRUE)
y <- scan(arguments[1], quiet = TRUE)
name <- arguments[2]
given <- as.numeric(arguments[-(1:2)])

stationary <- function(T, V) {
  n <- nrow(T)
  matrix(solve(diag(n * n) - kronecker(T, T), as.vector(V)), n, n)
}
model <- function(T, V, first, Z, h) {
  n <- nrow(T)
  list(T = T, V = V, h = h, Z = Z, a = rep(0, n), P = matrix(0, n, n), Pn = first)
}
white_markov <- function(p) {
  phi <- exp(-p[2])
  model(matrix(phi), matrix(p[3] * (1 - phi^2)), matrix(p[3]), 1, p[1])
}
white_markov_walk <- function(p) {
  phi <- exp(-p[2])
  model(diag(c(phi, 1)), diag(c(p[3] * (1 - phi^2), p[4])), diag(c(p[3], 0)), c(1, 1), p[1])
}
# Partial autocorrelations, variance of the innovation; then beta and sigma2 of a Gauss-Markov process.
ar2_markov <- function(p) {
  phi <- exp(-p[4])
  T <- matrix(0, 3, 3)
  T[1, 1:2] <- c(p[1] * (1 - p[2]), p[2])
  T[2, 1] <- 1
  T[3, 3] <- phi
  V <- diag(c(p[3], 0, p[5] * (1 - phi^2)))
  model(T, V, stationary(T, V), c(1, 0, 1), 0)
}
build <- get(name)
partial <- if (name == "ar2_markov") c(TRUE, TRUE, FALSE, FALSE, FALSE) else rep(FALSE, length(given))
inside <- function(p) suppressWarnings(ifelse(partial, atanh(p), log(p)))
outside <- function(u) ifelse(partial, tanh(u), exp(u))

# KalmanRun's standardised residuals r are e/sqrt(F); its first value is half of log(mean r^2) plus the mean of log F.
log_likelihood <- function(p) {
  run <- KalmanRun(y, build(p), nit = 0L)
  n <- length(y)
  squares <- sum(run$resid^2)
  log_F <- n * (2 * run$values[[1]] - log(squares / n))
  -0.5 * (n * log(2 * pi) + log_F + squares)
}
# Where a step goes beyond what has a likelihood, the line search comes back.
cost <- function(u) {
  value <- tryCatch(-log_likelihood(outside(u)), error = function(e) Inf)
  if (is.finite(value)) value else 1e10
}
found <- optim(inside(given), cost, method = "BFGS", control = list(reltol = 1e-14, maxit = 500))
found <- optim(found$par, cost, method = "BFGS", control = list(reltol = 1e-15, maxit = 500))
cat(sprintf("%.12f", c(log_likelihood(given), -found$value)), sprintf("%.12g", outside(found$par)), "\n")
