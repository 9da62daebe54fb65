(define (domain warehouse)
  (:requirements :strips)
  (:predicates (parked ?bay) (lane ?from ?to) (served ?bay) (forks ?level) (rack ?from ?to) (raised ?level))
  (:action glide
    :parameters (?from ?to)
    :precondition (and (parked ?from) (lane ?from ?to))
    :effect (and (not (parked ?from)) (parked ?to) (served ?to)))
  (:action hoist
    :parameters (?low ?high)
    :precondition (and (forks ?low) (rack ?low ?high))
    :effect (and (not (forks ?low)) (forks ?high) (raised ?high))))
